#include "lamella/pipeline/layer_warnings.hpp"

#include "lamella/contour/measure.hpp"

#include "core/counted.hpp"
#include "slicing/near_faces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lamella {
namespace {

/// "in 3 of 20 layers, first at z = 0.25 mm".
std::string where(const AffectedLayers& affected, std::uint64_t layers) {
    constexpr double nearly_0 = 1e-7; // what single precision leaves where 0 is meant
    const double z = std::abs(affected.first_z) < nearly_0 ? 0 : affected.first_z;
    return fmt::format("in {} of {}, first at z = {:.6g} mm", affected.layers, counted(layers, "layer"), z);
}

std::string power_of_ten_above(double length_mm);

/// Why chains are open with such gaps, and what closes them.
std::string open_gaps_text(double longest_mm) {
    // More than rounding leaves between the edge of a triangle and a vertex of its neighbours on it.
    constexpr double slit = 1e-3;
    return longest_mm <= slit
               ? fmt::format(
                     "contours do not close, though no gap is longer than {:.2g} mm: vertices lie on edges "
                     "of "
                     "neighbours (T-junctions), or vertices are not joined; `close_gaps_mm` {} closes them",
                     longest_mm, power_of_ten_above(longest_mm))
               : fmt::format("contours do not close where the mesh has holes or flipped triangles, the "
                             "longest gap is "
                             "{:.6g} mm",
                             longest_mm);
}

/// "1e-5": what an option takes where so much is to be within it.
std::string power_of_ten_above(double length_mm) {
    constexpr double least = 1e-6; // what is less is rounding
    return fmt::format("1e{}", static_cast<int>(std::ceil(std::log10(std::max(length_mm, least)))));
}

} // namespace

void AffectedLayers::add(double z) noexcept {
    if (layers++ == 0)
        first_z = z;
}

void NearFaceLayers::add(double z, double area, double farthest) noexcept {
    AffectedLayers::add(z);
    area_mm2 += area;
    farthest_mm = std::max(farthest_mm, farthest);
}

std::string NearFaceLayers::text(std::uint64_t all_layers) const {
    if (layers == 0)
        return {};
    return fmt::format(
        "{:.4g} mm2 of level faces lie within rounding of a plane {}: rounding decides whether these "
        "layers are cut above or below them; `snap_mm` {} counts them as on the plane",
        area_mm2, where(*this, all_layers), power_of_ten_above(farthest_mm));
}

NearFaceLayers near_faces(const Mesh& mesh, const Plan& plan, const Execution& execution) {
    NearFaceLayers found;
    if (mesh.empty())
        return found;
    NearFaceFinder finder(plan, bounding_box(mesh, execution));
    add_near_faces(finder, mesh, execution);
    for (const NearFaces& faces : finder.found())
        if (finder.matters(faces))
            found.add(plan.layers[faces.plane].z, finder.area_mm2(faces), faces.farthest_mm);
    return found;
}

void MeshDoubts::add(double z, const OpenGaps& gaps, bool clockwise) noexcept {
    ++layers;
    if (gaps.count > 0)
        open.add(z);
    open_gaps += gaps;
    if (clockwise)
        inside_out.add(z);
}

std::vector<std::string> MeshDoubts::texts() const {
    std::vector<std::string> texts;
    if (open_gaps.count > 0)
        texts.push_back(fmt::format("{} {}: {}", counted(open_gaps.count, "open chain"), where(open, layers),
                                    open_gaps_text(open_gaps.longest_mm)));
    // A ring that goes first is an outer one only where all contours are closed: of a mesh with holes it may
    // be that of a hollow, and what lies around it an open chain.
    if (inside_out.layers > 0 && open_gaps.count > 0)
        texts.push_back(fmt::format("closed contours with none around them run clockwise {}, as around "
                                    "holes: those around them stay open, or triangles face inwards",
                                    where(inside_out, layers)));
    else if (inside_out.layers > 0)
        texts.push_back(fmt::format("inside out {}: outer contours run clockwise, as around holes, because "
                                    "triangles face inwards",
                                    where(inside_out, layers)));
    return texts;
}

void ScanLosses::add(std::span<const Layer> parts) {
    ++layers;
    bool turned = false;
    for (const Layer& layer : parts) {
        hatches += layer.hatches.size() / 2;
        open_chains += layer.open_chains();
        turned |= layer.open_chains() == 0 && begins_clockwise(layer);
    }
    if (turned)
        inside_out.add(parts.front().z);
}

std::vector<std::string> ScanLosses::texts() const {
    std::vector<std::string> texts;
    if (hatches > 0)
        texts.push_back(fmt::format("{} left out: layers are hatched anew", counted(hatches, "hatch line")));
    if (open_chains > 0)
        texts.push_back(fmt::format("{} left out: only closed contours bound material",
                                    counted(open_chains, "open contour")));
    if (inside_out.layers > 0)
        texts.push_back(fmt::format("inside out {}: outer contours run clockwise, as around holes, and bound "
                                    "no material; to fill them by the rule nonzero turns them round",
                                    where(inside_out, layers)));
    return texts;
}

} // namespace lamella
