#include "lamella/contour/exposure.hpp"
#include "lamella/core/error.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/jobs/layer_findings.hpp"
#include "lamella/scan/scan.hpp"
#include "lamella/scan/strategy.hpp"

#include "bindings.hpp"
#include "classes.hpp"
#include "gil_release.hpp"
#include "run.hpp"
#include "shared_layer.hpp"
#include "texts.hpp"

#include <pybind11/stl.h>

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace py = pybind11;

namespace lamella::python {
namespace {

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
    Plane& vectors = scanned.vectors;
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
    complete(cls, "_rules");
}

} // namespace

void bind_scanning(py::module_& module) {
    bind_exposure(module);
    bind_figures(module);
    bind_losses(module);
    module.def("exposures", &exposures);
    module.def("support_exposures", &support_exposures);
    module.def("scan", &scanned);
    module.def("scan_support", &scanned_support);
    module.def("measure_vectors", &measured);
}

} // namespace lamella::python
