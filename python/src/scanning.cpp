#include "scanning.hpp"

#include "lamella/contour/exposure.hpp"
#include "lamella/core/error.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/pipeline/layer_findings.hpp"
#include "lamella/scan/scan.hpp"
#include "lamella/scan/strategy.hpp"
#include "lamella/scan/strategy_fields.hpp"

#include "gil_release.hpp"
#include "layers.hpp"
#include "pickled.hpp"
#include "run.hpp"
#include "shared_layer.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace py = pybind11;

namespace lamella::python {
namespace {

/// Returns the value after conversion by a check of the package, whose errors name the attribute.
template <class Value, class... More>
Value checked(const char* check, const char* name, const py::object& value, const More&... more) {
    return py::module_::import("lamella._arguments").attr(check)(name, value, more...).template cast<Value>();
}

template <class Value>
void set_value(const char* name, Value& into, const py::object& value) {
    if constexpr (std::is_enum_v<Value>) {
        const NamedValues<Value> known = named_values(Value{});
        const auto chosen = checked<std::string>("choice", name, value, known.names());
        into = *std::ranges::find(known.values, chosen, known.name);
    } else if constexpr (std::is_same_v<Value, bool>)
        into = checked<bool>("flag", name, value);
    else if constexpr (std::is_integral_v<Value>)
        into = checked<Value>("whole", name, value, 0, std::numeric_limits<Value>::max());
    else
        into = checked<Value>("number", name, value);
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
                checked<py::object>("refuse_type", name,
                                    py::str("a lamella.{}").format(py::type::of<Part>().attr("__name__")),
                                    value);
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
                        set_value(key, rule.*member, value);
                    },
                    text.c_str());
            },
            field.member);
    return cls;
}

std::vector<ScanLayer> layers_of(const std::vector<LayerPointer>& shared, const Rounding& rounding,
                                 const LayerLimits& limits) {
    std::vector<ScanLayer> layers;
    for (const LayerPointer& layer : shared)
        layers.emplace_back(layer->get(), rounding, limits);
    return layers;
}

/// Returns the rounding of the file that the layers come from, if any.
Rounding rounding_of(const Stack* stack) {
    return stack != nullptr ? stack->rounding : Rounding{};
}

/// Layers of vectors, and the area of material that no vector reaches, in mm^2.
using Scanned = std::pair<std::vector<LayerPointer>, double>;

Scanned shared_vectors(ScannedLayer scanned, const LayerPointer& layer) {
    ScanVectors& vectors = scanned.vectors;
    return {shared(std::move(vectors.polylines), layer->rule(), std::move(vectors.hatches)),
            std::accumulate(scanned.unreached_mm2.begin(), scanned.unreached_mm2.end(), 0.0)};
}

Scanned scanned(const LayerPointer& layer, const std::vector<LayerPointer>& below,
                const std::vector<LayerPointer>& above, const ScanStrategy& strategy, const Stack* stack) {
    std::size_t points = layer->get().points.size();
    for (const auto* beside : {&below, &above})
        for (const LayerPointer& other : *beside)
            points += other->get().points.size();
    const auto work = [layer, below, above, strategy,
                       rounding = rounding_of(stack)](const Execution& execution) {
        const LayerLimits limits = layer_limits(execution);
        return shared_vectors(scan(ScanLayer(layer->get(), rounding, limits),
                                   layers_of(below, rounding, limits), layers_of(above, rounding, limits),
                                   strategy, {.limits = limits}),
                              layer);
    };
    return result_of_points(points, work);
}

Scanned scanned_support(const LayerPointer& layer, const ScanStrategy& strategy, const Stack* stack) {
    const auto work = [layer, strategy, rounding = rounding_of(stack)](const Execution& execution) {
        const LayerLimits limits = layer_limits(execution);
        return shared_vectors(
            scan_support(ScanLayer(layer->get(), rounding, limits), strategy, {.limits = limits}), layer);
    };
    return result_of_points(layer->get().points.size(), work);
}

std::vector<ScanFigures> measured(const std::vector<LayerPointer>& vectors,
                                  const std::vector<Exposure>& exposures) {
    const GilRelease released;
    std::vector<ScanFigures> figures;
    std::optional<Point2> beam;
    for (std::size_t i = 0; i < vectors.size(); ++i) {
        const MeasuredVectors measured = measure_vectors(vectors[i]->get(), vectors[i]->hatches().span(),
                                                         exposures.at(i).parameters, beam);
        beam = measured.beam;
        figures.push_back(measured.figures);
    }
    return figures;
}

/// Adds the hatch lines of a slice file, which are replaced.
Findings with_hatch_lines(Findings findings, std::uint64_t hatch_lines) {
    if (hatch_lines > 0)
        findings.add({.kind = FindingKind::replaced_hatch_lines, .count = hatch_lines});
    return findings;
}

/// Searches layers of a slice file that arrive one by one.
class LossSearch {
  public:
    /// Adds the layers of the parts on the next plane.
    void add(const std::vector<LayerPointer>& parts) {
        for (std::size_t i = 0; i < parts.size(); ++i) {
            hatch_lines_ += parts[i]->hatches().size() / 2;
            // A call that Ctrl-C interrupts may go on for a while; what it uses must live as long.
            static_cast<void>(
                result_of_points(parts[i]->get().points.size(),
                                 [search = search_, plane = planes_, i, part = parts[i]](const Execution&) {
                                     search->look_at(plane, i, part->get());
                                     return true;
                                 }));
        }
        ++planes_;
    }
    [[nodiscard]] std::vector<std::string> texts() const {
        return with_hatch_lines(search_->findings(), hatch_lines_).texts();
    }

  private:
    std::shared_ptr<LayerFindingSearch> search_ =
        std::make_shared<LayerFindingSearch>(0, LayerUse::scanned, Rounding(), InversionSearch::full);
    std::size_t planes_ = 0;
    std::uint64_t hatch_lines_ = 0;
};

void bind_losses(py::module_& module) {
    py::class_<LossSearch>(module, "ScanLosses")
        .def(py::init())
        .def("add", &LossSearch::add)
        .def("texts", &LossSearch::texts);
    module.def("scan_losses", [](const Stack& stack) {
        return result_of(0, py::none(), [&](const Execution& execution) {
            std::uint64_t hatch_lines = 0;
            for (const LayerPointer& layer : stack.layers)
                hatch_lines += layer->hatches().size() / 2;
            return with_hatch_lines(layer_findings(source_of(plain_parts(stack), stack.rounding, execution),
                                                   LayerUse::scanned, InversionSearch::full, execution),
                                    hatch_lines)
                .texts();
        });
    });
    module.def("inverted_layers", [](const Stack& stack, unsigned threads, const py::object& progress) {
        return result_of(threads, progress, [&](const Execution& execution) {
            return layer_findings(source_of(plain_parts(stack), stack.rounding, execution), LayerUse::kept,
                                  InversionSearch::quick, execution)
                .texts();
        });
    });
}

void bind_rules(py::module_& module) {
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
}

bool same_exposures(const Exposure& a, const Exposure& b) {
    return a.part == b.part && a.region == b.region && a.kind == b.kind && a.contour == b.contour &&
           a.parameters == b.parameters;
}

py::tuple exposure_state(const Exposure& exposure) {
    return py::make_tuple(py::bytes(exposure.part), static_cast<unsigned>(exposure.region),
                          static_cast<unsigned>(exposure.kind), exposure.contour, exposure.parameters);
}

Exposure exposure_of_state(const py::tuple& state) {
    const auto region = state[1].cast<unsigned>();
    const auto kind = state[2].cast<unsigned>();
    if (region > static_cast<unsigned>(ScanRegion::support) ||
        kind > static_cast<unsigned>(VectorKind::hatch))
        throw Error(ErrorKind::input, "a pickled exposure is of no region or no kind that is known");
    return {state[0].cast<std::string>(), static_cast<ScanRegion>(region), static_cast<VectorKind>(kind),
            state[3].cast<std::uint32_t>(), state[4].cast<ParameterSet>()};
}

void bind_exposure(py::module_& module) {
    py::class_<Exposure> cls(
        module, "Exposure",
        "What the vectors of a part on a layer have in common that a machine executes in one go. It never "
        "changes.",
        own_new());
    cls.def_property_readonly(
           "part", [](const Exposure& self) { return path_text(self.part); }, "What the part is called.")
        .def_property_readonly(
            "region", [](const Exposure& self) { return scan_region_name(self.region); },
            "\"core\", \"upskin\", \"downskin\" or \"support\".")
        .def_property_readonly(
            "kind", [](const Exposure& self) { return vector_kind_name(self.kind); },
            "\"contour\" or \"hatch\".")
        .def_readonly("contour", &Exposure::contour,
                      "The number of a contour, from outside, from 1; 0 for hatches.")
        .def_property_readonly(
            "parameters", [](const Exposure& self) { return ParameterSet(self.parameters); },
            "What the beam does: a ParameterSet, which is a copy.")
        .def_property_readonly("name", &Exposure::name, "Such as \"core contour 1\".")
        .def("__eq__", &same_exposures, py::is_operator())
        .def("__hash__", [](const Exposure& self) { return py::hash(py::bytes(self.label())); })
        .def("__repr__", [](const Exposure& self) {
            return py::str("<lamella.Exposure {} {}>").format(path_text(self.part), self.name());
        });
    bind_pickle(cls, "exposure", 5, &exposure_state, &exposure_of_state);
}

auto figures_of(const ScanFigures& figures) {
    return std::tuple(figures.vectors, figures.marked_mm, figures.jumped_mm, figures.build_seconds,
                      figures.energy_j);
}

void bind_figures(py::module_& module) {
    py::class_<ScanFigures> cls(module, "ScanFigures", "What a machine does for vectors.", own_new());
    cls.def_readonly("vectors", &ScanFigures::vectors, "How many lines.")
        .def_readonly("marked_mm", &ScanFigures::marked_mm, "Their length in millimetres.")
        .def_readonly("jumped_mm", &ScanFigures::jumped_mm, "The ways between them in millimetres.")
        .def_readonly("build_seconds", &ScanFigures::build_seconds, "By speeds and delays alone.")
        .def_readonly("energy_j", &ScanFigures::energy_j, "Power by the time of marking, in joules.")
        .def(
            "__eq__",
            [](const ScanFigures& a, const ScanFigures& b) { return figures_of(a) == figures_of(b); },
            py::is_operator());
    bind_pickle(
        cls, "figures", 5, [](const ScanFigures& self) { return py::tuple(py::cast(figures_of(self))); },
        [](const py::tuple& state) {
            return ScanFigures{state[0].cast<std::uint64_t>(), state[1].cast<double>(),
                               state[2].cast<double>(), state[3].cast<double>(), state[4].cast<double>()};
        });
}

} // namespace

void bind_scanning(py::module_& module) {
    bind_rules(module);
    bind_exposure(module);
    bind_figures(module);
    bind_losses(module);
    module.def("check_strategy", &check_strategy);
    module.def("strategy_text", [](const ScanStrategy& strategy) { return strategy_text(strategy); });
    module.def("exposures", &exposures);
    module.def("support_exposures", &support_exposures);
    module.def("scan", &scanned);
    module.def("scan_support", &scanned_support);
    module.def("measure_vectors", &measured);
}

} // namespace lamella::python
