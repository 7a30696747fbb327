#pragma once

// The temporary names in use, for `remove_unfinished`.

#include "lamella/core/whole_file.hpp"

#include <string>

namespace lamella {

/// One temporary name that is taken down for removal as long as this object lives.
class UnfinishedName {
  public:
    UnfinishedName() = default;
    ~UnfinishedName() { withdraw(); }
    UnfinishedName(const UnfinishedName&) = delete;
    UnfinishedName& operator=(const UnfinishedName&) = delete;

    /// Takes down the name of what has just been created. False when the process is about to end: then the
    /// caller has to remove it and to stop. To be called once.
    [[nodiscard]] bool announce(const std::string& path);

    /// Forgets it: what had the name has its final one, or is gone. False when it has been removed.
    bool withdraw() noexcept;

    /// To be held from before a name is created until it is announced, or, where that was refused, removed
    /// again: remove_unfinished waits for those who hold one, and after that nobody gets one:
    /// Error{cancelled}.
    class Creation {
      public:
        Creation();
        ~Creation();
        Creation(const Creation&) = delete;
        Creation& operator=(const Creation&) = delete;
    };

    struct Slot;

  private:
    Slot* slot_ = nullptr;
};

} // namespace lamella
