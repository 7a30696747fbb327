#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace lamella {

/// Makes names of parts unique, for formats that identify parts by their names.
class DistinctNames {
  public:
    /// Returns the name, with a number appended if another part has it already.
    std::string of(const std::string& name);

    /// Return the number of names that were changed, and the first changed name.
    [[nodiscard]] std::uint64_t changed() const noexcept { return changed_; }
    [[nodiscard]] const std::string& first_changed() const noexcept { return first_changed_; }

  private:
    std::map<std::string, std::uint64_t> taken_; ///< each name, with the number that was appended to it last
    std::uint64_t changed_ = 0;
    std::string first_changed_;
};

} // namespace lamella
