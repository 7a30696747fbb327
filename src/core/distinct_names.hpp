#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace lamella {

/// Names for parts that are told apart otherwise where they come from, and by their names where they go.
class DistinctNames {
  public:
    /// The name, with a number behind it where another part has it already.
    std::string of(const std::string& name);

    /// How many names were changed, and the first of them, as it is now.
    [[nodiscard]] std::uint64_t changed() const noexcept { return changed_; }
    [[nodiscard]] const std::string& first_changed() const noexcept { return first_changed_; }

  private:
    std::map<std::string, std::uint64_t> taken_; ///< with the number that was put behind it last
    std::uint64_t changed_ = 0;
    std::string first_changed_;
};

} // namespace lamella
