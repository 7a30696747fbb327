#pragma once

// Tables of TOML files as the library reads settings from them.

#include "lamella/scan/strategy_fields.hpp"

#include "toml_file.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::app {

/// Where values are in a file, by their paths.
using TomlLocations = std::map<std::string, std::string>;

/// A value of a TOML file. Notes the locations of all values that are read.
class TomlTables : public StrategyValue {
  public:
    /// `whole` says for errors what the file is, such as "a strategy". All three must outlive the object.
    TomlTables(const TomlValue& value, TomlLocations& locations, std::string_view whole)
        : value_(value), locations_(locations), whole_(whole) {}

    void each(const std::string& name, const Visit& visit) const override;
    double number(const std::string& name) const override;
    std::uint64_t count(const std::string& name, std::uint64_t most) const override;
    bool flag(const std::string& name) const override;
    std::string choice(const std::string& name, const std::vector<std::string>& names) const override;
    std::string text(const std::string& name, std::string_view expected, bool may_be_empty) const override;

    [[noreturn]] void refuse_key(const std::string& name, const std::string& key,
                                 const std::vector<std::string>& known) const override;
    [[noreturn]] void refuse_entry(const std::string& name, const std::string& key,
                                   std::string_view reason) const override;
    [[noreturn]] void refuse_set(const std::string& name, const std::string& set,
                                 const std::vector<std::string>& known) const override;
    [[noreturn]] void refuse_unused(const std::string& set,
                                    const std::vector<std::string>& used) const override;

  private:
    template <class Kind>
    const Kind* as(const std::string& name) const {
        locations_[name] = value_.location;
        return value_.as<Kind>();
    }

    const TomlValue& value_;
    TomlLocations& locations_;
    std::string_view whole_;
};

} // namespace lamella::app
