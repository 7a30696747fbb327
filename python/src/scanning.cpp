#include "scanning.hpp"

#include "lamella/contour/exposure.hpp"
#include "lamella/core/error.hpp"
#include "lamella/scan/scan.hpp"
#include "lamella/scan/strategy.hpp"
#include "lamella/scan/strategy_fields.hpp"

#include "layers.hpp"
#include "shared_layer.hpp"

#include <pybind11/operators.h>
#include <pybind11/stl.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

namespace py = pybind11;

namespace lamella::python {
namespace {

/// As errors of Python name it.
template <class Value>
void set_value(const char* name, Value& into, const py::object& value) {
    try {
        into = value.cast<Value>();
    } catch (const py::cast_error&) {
        throw py::type_error(std::string(name) + ": " + Py_TYPE(value.ptr())->tp_name + " is not possible");
    }
}

template <class Choice>
requires std::is_enum_v<Choice>
void set_value(const char* name, Choice& into, const py::object& value) {
    const NamedValues<Choice> known = named_values(Choice{});
    std::string wanted;
    set_value(name, wanted, value);
    std::string there_are;
    for (const Choice choice : known.values) {
        if (known.name(choice) == wanted) {
            into = choice;
            return;
        }
        there_are += (there_are.empty() ? "" : ", ") + std::string(known.name(choice));
    }
    throw Error(ErrorKind::usage,
                std::string(name) + ": \"" + wanted + "\" is not possible; there are " + there_are);
}

template <class Value>
py::object value_of(const Value& value) {
    if constexpr (std::is_enum_v<Value>)
        return py::cast(named_values(Value{}).name(value));
    else
        return py::cast(value);
}

/// Attributes by the table of fields.
template <class Rule>
py::class_<Rule> bind_rule(py::module_& module, const char* name, const char* about,
                           std::span<const StrategyField<Rule>> fields) {
    py::class_<Rule> cls(module, name, about);
    cls.def(py::init());
    for (const StrategyField<Rule>& field : fields)
        std::visit(
            [&](const auto member) {
                const char* const key = field.name.data(); // a literal
                std::string text(field.unit);
                text += (text.empty() ? "" : ", ") + std::string(field.help);
                cls.def_property(
                    key, [member](const Rule& rule) { return value_of(rule.*member); },
                    [member, key](Rule& rule, const py::object& value) {
                        set_value(key, rule.*member, value);
                    },
                    text.c_str());
            },
            field.member);
    return cls;
}

std::vector<ScanLayer> layers_of(const std::vector<LayerPointer>& shared) {
    std::vector<ScanLayer> layers;
    for (const LayerPointer& layer : shared)
        layers.emplace_back(layer->get());
    return layers;
}

std::vector<LayerPointer> scanned(const SharedLayer& layer, const std::vector<LayerPointer>& below,
                                  const std::vector<LayerPointer>& above, const ScanStrategy& strategy) {
    const py::gil_scoped_release released;
    return shared(scan(layer.get(), layers_of(below), layers_of(above), strategy));
}

std::vector<LayerPointer> scanned_support(const SharedLayer& layer, const ScanStrategy& strategy) {
    const py::gil_scoped_release released;
    return shared(scan_support(layer.get(), strategy));
}

std::vector<ScanFigures> measured(const std::vector<LayerPointer>& vectors,
                                  const std::vector<Exposure>& exposures) {
    const py::gil_scoped_release released;
    std::vector<ScanFigures> figures;
    std::optional<Point2> beam;
    for (std::size_t i = 0; i < vectors.size(); ++i)
        figures.push_back(measure_vectors(vectors[i]->get(), exposures.at(i).parameters, beam));
    return figures;
}

void bind_rules(py::module_& module) {
    constexpr const char* parameters = "What the beam does along these lines: a ParameterSet.";
    bind_rule(module, "ParameterSet", "What a beam does along vectors and between them.", parameter_fields())
        .def(py::init<const ParameterSet&>())
        .def_readwrite("name", &ParameterSet::name, "What files and machines call it.")
        .def(py::self == py::self);
    bind_rule(module, "HatchRule", "Parallel lines that fill an area.", hatch_fields())
        .def_readwrite("parameters", &HatchRule::parameters, parameters);
    bind_rule(module, "ContourRule", "Lines along the outline of the part.", contour_fields())
        .def_readwrite("parameters", &ContourRule::parameters, parameters);
    bind_rule(module, "SkinRule", "Where a layer has little material above it, or below.", skin_fields())
        .def_readwrite("hatch", &SkinRule::hatch, "Its lines: a HatchRule.");
    py::class_<SupportRule>(module, "SupportRule", "All of what is a support, which has no skins.")
        .def(py::init())
        .def_readwrite("contours", &SupportRule::contours, "Lines along its outline: a ContourRule.")
        .def_readwrite("hatch", &SupportRule::hatch, "Lines that fill it: a HatchRule.");
    bind_rule(module, "ScanStrategy",
              "How a powder-bed machine is to expose a part: contours, hatches, skins. By default what makes "
              "sense\n"
              "for 316L steel and layers of 0.03 mm.",
              strategy_fields())
        .def_readwrite("contours", &ScanStrategy::contours, "Lines along the outline: a ContourRule.")
        .def_readwrite("hatch", &ScanStrategy::hatch, "Lines that fill the core: a HatchRule.")
        .def_readwrite("upskin", &ScanStrategy::upskin, "Where there is little material above: a SkinRule.")
        .def_readwrite("downskin", &ScanStrategy::downskin,
                       "Where there is little material below: a SkinRule.")
        .def_readwrite("support", &ScanStrategy::support, "What is a support: a SupportRule.");
}

} // namespace

void bind_scanning(py::module_& module) {
    bind_rules(module);
    py::class_<Exposure>(
        module, "Exposure",
        "What the vectors of a part on a layer have in common that a machine executes in one go.")
        .def_property_readonly(
            "part", [](const Exposure& self) { return path_text(self.part); }, "What the part is called.")
        .def_property_readonly(
            "region", [](const Exposure& self) { return scan_region_name(self.region); },
            "\"core\", \"upskin\", \"downskin\" or \"support\".")
        .def_property_readonly(
            "kind", [](const Exposure& self) { return vector_kind_name(self.kind); },
            "\"contour\" or \"hatch\".")
        .def_readonly("contour", &Exposure::contour,
                      "The number of a contour, from outside, from 1; 0 for hatches.")
        .def_readonly("parameters", &Exposure::parameters, "What the beam does: a ParameterSet.")
        .def_property_readonly("name", &Exposure::name, "Such as \"core contour 1\".")
        .def("__repr__",
             [](const Exposure& self) { return "<lamella.Exposure " + self.part + " " + self.name() + ">"; });
    py::class_<ScanFigures>(module, "ScanFigures", "What a machine does for vectors.")
        .def_readonly("vectors", &ScanFigures::vectors, "How many lines.")
        .def_readonly("marked_mm", &ScanFigures::marked_mm, "Their length in millimetres.")
        .def_readonly("jumped_mm", &ScanFigures::jumped_mm, "The ways between them in millimetres.")
        .def_readonly("build_seconds", &ScanFigures::build_seconds, "By speeds and delays alone.")
        .def_readonly("energy_j", &ScanFigures::energy_j, "Power by the time of marking, in joules.");
    module.def("check_strategy", &check_strategy);
    module.def("exposures", &exposures);
    module.def("support_exposures", &support_exposures);
    module.def("scan", &scanned);
    module.def("scan_support", &scanned_support);
    module.def("measure_vectors", &measured);
}

} // namespace lamella::python
