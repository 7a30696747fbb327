#pragma once

// Tables of settings, in whatever format people write them.

#include "lamella/core/api.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// A value from which settings or a field of them are read: in a TOML file, a dict of Python. `name` is its
/// path, such as "upskin.hatch.distance", and "" for the whole. All functions throw an error in the words of
/// the format, with the location, if the value is another one than they return.
class TableValue {
  public:
    TableValue() = default;
    TableValue(const TableValue&) = delete;
    TableValue& operator=(const TableValue&) = delete;
    virtual ~TableValue() = default;

    using Visit = std::function<void(const std::string& key, const TableValue& value)>;
    /// Calls `visit` for each value of a table.
    virtual void each(const std::string& name, const Visit& visit) const = 0;
    [[nodiscard]] virtual double number(const std::string& name) const = 0;
    [[nodiscard]] virtual std::uint64_t count(const std::string& name, std::uint64_t most) const = 0;
    [[nodiscard]] virtual bool flag(const std::string& name) const = 0;
    [[nodiscard]] virtual std::string choice(const std::string& name,
                                             const std::vector<std::string>& names) const = 0;
    /// Returns a text, which may be empty if `may_be_empty`. `expected` describes it for errors.
    [[nodiscard]] virtual std::string text(const std::string& name, std::string_view expected,
                                           bool may_be_empty) const = 0;

    /// Throws for a key that the table `name` cannot have.
    [[noreturn]] virtual void refuse_key(const std::string& name, const std::string& key,
                                         const std::vector<std::string>& known) const = 0;
    /// Throws for an entry of the table `name`. `reason` continues a text that ends with its key, such as
    /// "which ends below its beginning".
    [[noreturn]] virtual void refuse_entry(const std::string& name, const std::string& key,
                                           std::string_view reason) const = 0;
};

} // namespace lamella
LAMELLA_API_END
