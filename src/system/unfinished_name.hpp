#pragma once

// The temporary names in use, for `remove_unfinished`.

#include "lamella/system/whole_file.hpp"

#include "system/ending.hpp"

#include <string>

namespace lamella {

/// A temporary name that is registered for removal as long as this object lives.
class UnfinishedName {
  public:
    UnfinishedName() = default;
    ~UnfinishedName() { withdraw(); }
    UnfinishedName(const UnfinishedName&) = delete;
    UnfinishedName& operator=(const UnfinishedName&) = delete;

    /// Registers the name of a newly created file or folder. Returns false if the process is about to end;
    /// then the caller must remove the file and stop. Must be called once.
    [[nodiscard]] bool announce(const std::string& path);

    /// Removes the registration, after the file got its final name or was removed. Returns false if
    /// remove_unfinished has already taken the name.
    bool withdraw() noexcept;

    /// Must be held from before a name is created until it is announced or, if that fails, removed again.
    /// remove_unfinished waits for all holders; after that the constructor throws Error{cancelled}. Signals
    /// that end the program are held back from this thread, because their handler could not wait for the
    /// thread that it interrupts.
    class Creation {
      public:
        Creation();
        ~Creation();
        Creation(const Creation&) = delete;
        Creation& operator=(const Creation&) = delete;

      private:
        EndingSignalHold hold_; ///< until the creation has ended
    };

    struct Slot;

  private:
    Slot* slot_ = nullptr;
};

} // namespace lamella
