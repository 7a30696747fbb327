#pragma once

// Options of scan vectors: a strategy, and changes to it.

#include "lamella/scan/strategy.hpp"

#include "command.hpp"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace lamella::app {

struct ScanArguments {
    std::string file; ///< file of the strategy; "" means the defaults
    /// Changes by options, with their names, in the order in which they were given.
    std::vector<std::pair<std::string, std::function<void(ScanStrategy&)>>> changes = {};

    [[nodiscard]] bool given() const noexcept { return !file.empty() || !changes.empty(); }

    /// Reads the file and applies the changes. Throws the errors of read_strategy, and Error{usage} that
    /// names the option for a value out of range.
    [[nodiscard]] ScanStrategy strategy() const;
};
/// `first` are options that precede these.
[[nodiscard]] OptionGroup scan_options(ScanArguments& target, std::vector<Option> first = {});

} // namespace lamella::app
