#include "lamella/contour/exposure.hpp"
#include "lamella/jobs/layer_files.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

namespace lamella {

namespace {

/// The figures of one plane, without the exposures themselves.
struct PlaneFigures {
    LayerMeasure contours;
    double volume_mm3 = 0;
    std::vector<ScanFigures> exposures;
};

PlaneFigures measure_plane(const PlaneSource& file, const Plane& plane) {
    PlaneFigures figures;
    std::optional<Point2> beam;
    for (std::size_t i = 0; i < file.parts.size(); ++i) {
        const Layer& layer = plane.polylines[i];
        const LayerMeasure contours = measure(layer);
        figures.contours.add(contours);
        figures.volume_mm3 += contours.area_mm2 * layer.thickness();
        if (const std::optional<Exposure>& exposure = file.parts[i].exposure) {
            const MeasuredVectors vectors =
                measure_vectors(layer, plane.hatches[i].span(), exposure->parameters, beam);
            beam = vectors.beam;
            figures.exposures.push_back(vectors.figures);
        }
    }
    return figures;
}

} // namespace

FileFigures measure(const PlaneSource& file, const Execution& execution) {
    FileFigures all;
    for (const PartInfo& part : file.parts)
        if (part.exposure)
            all.exposures.push_back({*part.exposure, {}});
    // Sums of rounded numbers depend on the order.
    const PlaneSink add = [&](std::size_t, const Plane& vectors) -> Commit {
        const auto plane = std::make_shared<const PlaneFigures>(measure_plane(file, vectors));
        return [&all, plane] {
            all.contours.add(plane->contours);
            all.volume_mm3 += plane->volume_mm3;
            for (std::size_t i = 0; i < plane->exposures.size(); ++i)
                all.exposures[i].figures += plane->exposures[i];
        };
    };
    file.run(Stage::polygon, add, execution);
    return all;
}

} // namespace lamella
