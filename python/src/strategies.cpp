#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"
#include "lamella/scan/strategy.hpp"
#include "lamella/scan/strategy_fields.hpp"

#include "bindings.hpp"
#include "checks.hpp"
#include "classes.hpp"
#include "made.hpp"
#include "python_tables.hpp"
#include "texts.hpp"

#include <pybind11/stl.h>

#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace py = pybind11;

namespace lamella::python {
namespace {

ScanStrategy strategy_of_tables(const py::bytes& source, const py::object& tables) {
    ScanStrategy strategy = strategy_of(PythonTables(source, tables));
    check_strategy(strategy);
    return strategy;
}

template <class Value>
py::object value_of(const Value& value) {
    if constexpr (std::is_enum_v<Value>)
        return py::cast(named_values(Value{}).name(value));
    else
        return py::cast(value);
}

/// Returns the values that an enumerated attribute can have.
template <class Rule, class Value>
std::string choices_of(Value Rule::* /*member*/) {
    std::string text;
    if constexpr (std::is_enum_v<Value>)
        for (const std::string& name : named_values(Value{}).names())
            text += (text.empty() ? ": \"" : ", \"") + name + '"';
    return text;
}

/// Binds an attribute that is itself a rule.
template <class Rule, class Part>
void bind_part(py::class_<Rule>& cls, const char* name, Part Rule::*part, const char* about) {
    cls.def_property(
        name, [part](Rule& rule) -> Part& { return rule.*part; },
        [part, name](Rule& rule, const py::object& value) {
            if (!py::isinstance<Part>(value))
                static_cast<void>(checked<py::object>(
                    "refuse_type", name,
                    py::str("a lamella.{}").format(py::type::of<Part>().attr("__name__")), value));
            rule.*part = value.cast<const Part&>();
        },
        about);
}

/// Binds attributes by the table of fields.
template <class Rule>
py::class_<Rule> bind_rule(py::module_& module, const char* name, const char* about,
                           std::span<const StrategyField<Rule>> fields) {
    py::class_<Rule> cls(module, name, about, own_new());
    cls.def(py::init());
    for (const StrategyField<Rule>& field : fields)
        std::visit(
            [&](const auto member) {
                const char* const key = field.name.data(); // a literal
                std::string text(field.unit);
                text += (text.empty() ? "" : ", ") + std::string(field.help) + choices_of(member);
                cls.def_property(
                    key, [member](const Rule& rule) { return value_of(rule.*member); },
                    [member, key](Rule& rule, const py::object& value) {
                        take(PythonTables({}, value), key, rule.*member);
                    },
                    text.c_str());
            },
            field.member);
    return cls;
}

} // namespace

void bind_strategies(py::module_& module) {
    constexpr const char* parameters = "What the beam does along these lines: a ParameterSet.";
    bind_rule(module, "ParameterSet", "What a beam does along vectors and between them.", parameter_fields())
        .def(py::init<const ParameterSet&>())
        .def_property(
            "name", [](const ParameterSet& self) { return path_text(self.name); },
            [](ParameterSet& self, const py::object& value) {
                self.name = checked<std::string>("label", "name", value);
            },
            "What files and machines call it.");
    auto hatch = bind_rule(module, "HatchRule", "Parallel lines that fill an area.", hatch_fields());
    bind_part(hatch, "parameters", &HatchRule::parameters, parameters);
    auto contour = bind_rule(module, "ContourRule", "Lines along the outline of the part.", contour_fields());
    bind_part(contour, "parameters", &ContourRule::parameters, parameters);
    auto skin =
        bind_rule(module, "SkinRule", "Where a layer has little material above it, or below.", skin_fields());
    bind_part(skin, "hatch", &SkinRule::hatch, "Its lines: a HatchRule.");
    py::class_<SupportRule> support(module, "SupportRule", "All of what is a support, which has no skins.",
                                    own_new());
    support.def(py::init());
    bind_part(support, "contours", &SupportRule::contours, "Lines along its outline: a ContourRule.");
    bind_part(support, "hatch", &SupportRule::hatch, "Lines that fill it: a HatchRule.");
    auto strategy =
        bind_rule(module, "ScanStrategy",
                  "How a powder-bed machine is to expose a part: contours, hatches, skins. By default what "
                  "makes sense\n"
                  "for 316L steel and layers of 0.03 mm.",
                  strategy_fields());
    bind_part(strategy, "contours", &ScanStrategy::contours, "Lines along the outline: a ContourRule.");
    bind_part(strategy, "hatch", &ScanStrategy::hatch, "Lines that fill the core: a HatchRule.");
    bind_part(strategy, "upskin", &ScanStrategy::upskin, "Where there is little material above: a SkinRule.");
    bind_part(strategy, "downskin", &ScanStrategy::downskin,
              "Where there is little material below: a SkinRule.");
    bind_part(strategy, "support", &ScanStrategy::support, "What is a support: a SupportRule.");
    strategy.def_static("_of_tables", &strategy_of_tables)
        .def("_check", [](const ScanStrategy& self) { check_strategy(self); })
        .def("_text", [](const ScanStrategy& self) { return strategy_text(self); });
    for (const char* const name :
         {"ParameterSet", "ContourRule", "HatchRule", "SkinRule", "SupportRule", "ScanStrategy"})
        complete(module.attr(name), "_rules");
}

} // namespace lamella::python
