#include "scanning.hpp"

#include "lamella/contour/exposure.hpp"
#include "lamella/core/error.hpp"
#include "lamella/scan/scan.hpp"
#include "lamella/scan/strategy.hpp"

#include "layers.hpp"
#include "shared_layer.hpp"

#include <pybind11/operators.h>
#include <pybind11/stl.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace py = pybind11;

namespace lamella::python {
namespace {

/// A choice as Python sees it: its name.
template <auto member, class Rule, class Choice, std::size_t count>
void bind_choice(py::class_<Rule>& cls, const char* name, const std::array<Choice, count>& choices,
                 std::string_view (*name_of)(Choice) noexcept) {
    cls.def_property(
        name, [name_of](const Rule& rule) { return name_of(rule.*member); },
        [name, choices, name_of](Rule& rule, const std::string& wanted) {
            std::string there_are;
            for (const Choice choice : choices) {
                if (name_of(choice) == wanted) {
                    rule.*member = choice;
                    return;
                }
                there_are += (there_are.empty() ? "" : ", ") + std::string(name_of(choice));
            }
            throw Error(ErrorKind::usage,
                        std::string(name) + ": \"" + wanted + "\" is not possible; there are " + there_are);
        });
}

std::vector<Layer> layers_of(const std::vector<LayerPointer>& shared) {
    std::vector<Layer> layers;
    for (const LayerPointer& layer : shared)
        layers.push_back(layer->get());
    return layers;
}

std::vector<LayerPointer> scanned(const SharedLayer& layer, const std::vector<LayerPointer>& below,
                                  const std::vector<LayerPointer>& above, const ScanStrategy& strategy) {
    const py::gil_scoped_release released;
    return shared(scan(layer.get(), layers_of(below), layers_of(above), strategy));
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
    py::class_<ParameterSet>(module, "ParameterSet", "What a beam does along vectors and between them.")
        .def(py::init())
        .def(py::init<const ParameterSet&>())
        .def_readwrite("name", &ParameterSet::name)
        .def_readwrite("power_w", &ParameterSet::power_w)
        .def_readwrite("speed_mm_s", &ParameterSet::speed_mm_s)
        .def_readwrite("jump_speed_mm_s", &ParameterSet::jump_speed_mm_s)
        .def_readwrite("focus_mm", &ParameterSet::focus_mm)
        .def_readwrite("spot_mm", &ParameterSet::spot_mm)
        .def_readwrite("mark_delay_us", &ParameterSet::mark_delay_us)
        .def_readwrite("jump_delay_us", &ParameterSet::jump_delay_us)
        .def(py::self == py::self);

    py::class_<HatchRule> hatch(module, "HatchRule",
                                "Parallel lines that fill an area; millimetres and degrees.");
    hatch.def(py::init())
        .def_readwrite("distance", &HatchRule::distance)
        .def_readwrite("angle_degrees", &HatchRule::angle_degrees)
        .def_readwrite("turn_degrees", &HatchRule::turn_degrees)
        .def_readwrite("border", &HatchRule::border)
        .def_readwrite("shortest", &HatchRule::shortest)
        .def_readwrite("cell", &HatchRule::cell)
        .def_readwrite("overlap", &HatchRule::overlap)
        .def_readwrite("parameters", &HatchRule::parameters);
    bind_choice<&HatchRule::pattern>(hatch, "pattern",
                                     std::array{HatchPattern::lines, HatchPattern::meander,
                                                HatchPattern::stripes, HatchPattern::chessboard,
                                                HatchPattern::hexagons},
                                     hatch_pattern_name);
    bind_choice<&HatchRule::order>(hatch, "order", std::array{IslandOrder::rows, IslandOrder::random},
                                   island_order_name);

    py::class_<ContourRule> contours(module, "ContourRule",
                                     "Lines along the outline of the part; millimetres.");
    contours.def(py::init())
        .def_readwrite("count", &ContourRule::count)
        .def_readwrite("beam_offset", &ContourRule::beam_offset)
        .def_readwrite("distance", &ContourRule::distance)
        .def_readwrite("before_hatch", &ContourRule::before_hatch)
        .def_readwrite("start_direction_degrees", &ContourRule::start_direction_degrees)
        .def_readwrite("parameters", &ContourRule::parameters);
    bind_choice<&ContourRule::order>(contours, "order",
                                     std::array{ContourOrder::inside_out, ContourOrder::outside_in},
                                     contour_order_name);
    bind_choice<&ContourRule::start>(
        contours, "start", std::array{StartPoint::aligned, StartPoint::sharpest, StartPoint::random},
        start_point_name);

    py::class_<SkinRule>(module, "SkinRule",
                         "Where a layer has little material above it, or below; millimetres.")
        .def(py::init())
        .def_readwrite("layers", &SkinRule::layers)
        .def_readwrite("overlap", &SkinRule::overlap)
        .def_readwrite("hatch", &SkinRule::hatch);

    py::class_<ScanStrategy>(
        module, "ScanStrategy",
        "How a powder-bed machine is to expose a part: contours, hatches, skins. By default what\n"
        "makes sense for 316L steel and layers of 0.03 mm; `lamella strategy show` explains each\n"
        "value.")
        .def(py::init())
        .def_readwrite("contours", &ScanStrategy::contours)
        .def_readwrite("hatch", &ScanStrategy::hatch)
        .def_readwrite("upskin", &ScanStrategy::upskin)
        .def_readwrite("downskin", &ScanStrategy::downskin)
        .def_readwrite("seed", &ScanStrategy::seed);
}

} // namespace

void bind_scanning(py::module_& module) {
    bind_rules(module);
    py::class_<Exposure>(
        module, "Exposure",
        "What the vectors of a part on a layer have in common that a machine executes in one go.")
        .def_property_readonly("part", [](const Exposure& self) { return path_text(self.part); })
        .def_property_readonly("region", [](const Exposure& self) { return scan_region_name(self.region); })
        .def_property_readonly("kind", [](const Exposure& self) { return vector_kind_name(self.kind); })
        .def_readonly("contour", &Exposure::contour)
        .def_readonly("parameters", &Exposure::parameters)
        .def_property_readonly("name", &Exposure::name)
        .def("__repr__",
             [](const Exposure& self) { return "<lamella.Exposure " + self.part + " " + self.name() + ">"; });
    py::class_<ScanFigures>(module, "ScanFigures", "What a machine does for vectors.")
        .def_readonly("vectors", &ScanFigures::vectors)
        .def_readonly("marked_mm", &ScanFigures::marked_mm)
        .def_readonly("jumped_mm", &ScanFigures::jumped_mm)
        .def_readonly("build_seconds", &ScanFigures::build_seconds)
        .def_readonly("energy_j", &ScanFigures::energy_j);
    module.def("check_strategy", &check_strategy);
    module.def("exposures", &exposures);
    module.def("scan", &scanned);
    module.def("measure_vectors", &measured);
}

} // namespace lamella::python
