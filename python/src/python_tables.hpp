#pragma once

// Dicts of Python as tables of settings, with errors that name the argument.

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"
#include "lamella/scan/strategy_fields.hpp"

#include "checks.hpp"
#include "texts.hpp"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella::python {

/// A value of a dict with tables of settings, or of an attribute. `source` begins the texts of errors:
/// the name of the argument or of the file; "" for an attribute.
class PythonTables : public StrategyValue {
  public:
    PythonTables(std::string source, pybind11::object value)
        : source_(std::move(source)), value_(std::move(value)) {}

    void each(const std::string& name, const Visit& visit) const override {
        const pybind11::object mapping = pybind11::module_::import("collections.abc").attr("Mapping");
        if (!pybind11::isinstance(value_, mapping))
            static_cast<void>(checked<pybind11::object>("refuse_type", place(name), "a table", value_));
        for (const pybind11::handle item : value_.attr("items")()) {
            const auto [key, value] = item.cast<std::pair<pybind11::object, pybind11::object>>();
            visit(checked<std::string>("label", place(name), key), PythonTables(source_, value));
        }
    }

    double number(const std::string& name) const override {
        return checked<double>("number", place(name), value_);
    }
    std::uint64_t count(const std::string& name, std::uint64_t most) const override {
        return checked<std::uint64_t>("whole", place(name), value_, 0, most);
    }
    bool flag(const std::string& name) const override { return checked<bool>("flag", place(name), value_); }
    std::string choice(const std::string& name, const std::vector<std::string>& names) const override {
        return checked<std::string>("choice", place(name), value_, names);
    }

    std::string text(const std::string& name, std::string_view expected, bool may_be_empty) const override {
        auto found = checked<std::string>("label", place(name), value_);
        if (found.empty() && !may_be_empty)
            refuse("{}: expected {}, found an empty text", place(name), std::string(expected));
        return found;
    }

    [[noreturn]] void refuse_key(const std::string& name, const std::string& key,
                                 const std::vector<std::string>& known) const override {
        const auto near = checked<std::string>("nearest", path_text(key), known);
        refuse("{}: there is no {}; {}", place(name), excerpt(key),
               near.empty() ? "there are " + joined(known) : "did you mean " + near + "?");
    }
    [[noreturn]] void refuse_entry(const std::string& name, const std::string& key,
                                   std::string_view reason) const override {
        refuse("{}: there is {}, {}", place(name), excerpt(key), std::string(reason));
    }
    [[noreturn]] void refuse_set(const std::string& name, const std::string& set,
                                 const std::vector<std::string>& known) const override {
        refuse("{}: there are no parameters {}; there are {}", place(name), excerpt(set),
               excerpt(joined(known)));
    }
    [[noreturn]] void refuse_unused(const std::string& set,
                                    const std::vector<std::string>& used) const override {
        refuse("{}: the parameters {} are used nowhere; there are {}", place({}), excerpt(set),
               path_text(joined(used)));
    }

  private:
    [[nodiscard]] pybind11::str place(const std::string& name) const {
        return path_text(source_ + (source_.empty() || name.empty() ? "" : ": ") + lamella::excerpt(name));
    }
    static pybind11::object excerpt(const std::string& text) {
        return checked<pybind11::object>("excerpt", path_text(text));
    }
    static std::string joined(const std::vector<std::string>& names) {
        std::string text;
        for (const std::string& name : names)
            text += (text.empty() ? "" : ", ") + name;
        return text;
    }
    template <class... Items>
    [[noreturn]] static void refuse(const char* text, const Items&... items) {
        const pybind11::object encoded =
            pybind11::module_::import("os").attr("fsencode")(pybind11::str(text).format(items...));
        throw Error(ErrorKind::usage, encoded.cast<std::string>());
    }

    std::string source_;
    pybind11::object value_;
};

} // namespace lamella::python
