#pragma once

// Options of scan vectors: a strategy, and what of it is to be otherwise.

#include "lamella/scan/strategy.hpp"

#include "command.hpp"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace lamella::app {

struct ScanArguments {
    std::string file; ///< of the strategy; "" takes what is by default
    /// What options say, with their names; in the order in which they were given.
    std::vector<std::pair<std::string, std::function<void(ScanStrategy&)>>> changes = {};

    [[nodiscard]] bool given() const noexcept { return !file.empty() || !changes.empty(); }

    /// Reads the file. Throws what read_strategy throws, and Error{usage} that names the option for a value
    /// out of range.
    [[nodiscard]] ScanStrategy strategy() const;
};
/// `first`: another option, in front of these.
[[nodiscard]] OptionGroup scan_options(ScanArguments& target, std::vector<Option> first = {});

} // namespace lamella::app
