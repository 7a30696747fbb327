#include "lamella/pipeline/layer_warnings.hpp"

#include "core/counted.hpp"
#include "core/executor.hpp"
#include "slicing/near_faces.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace lamella {
namespace {

/// Returns " of the part "ring"", " of the parts "a", "b" and 5 more"; "" for none, which means all.
std::string of_parts(std::span<const std::string> labels) {
    constexpr std::size_t few = 3;
    if (labels.empty())
        return {};
    const std::size_t named = std::min(few, labels.size());
    std::string text = fmt::format(" of the part{} \"{}\"", labels.size() == 1 ? "" : "s",
                                   fmt::join(labels.first(named), "\", \""));
    if (labels.size() > named)
        text += fmt::format(" and {} more", labels.size() - named);
    return text;
}

/// Returns "in 3 of 20 layers, first at z = 0.25 mm".
std::string where(const AffectedLayers& affected, std::uint64_t layers,
                  std::span<const std::string> parts = {}) {
    constexpr double nearly_0 = 1e-7; // rounding error of 0 in single precision
    const double z = std::abs(affected.first_z) < nearly_0 ? 0 : affected.first_z;
    return fmt::format("in {} of {}{}, first at z = {:.6g} mm", affected.layers, counted(layers, "layer"),
                       of_parts(parts), z);
}

/// Returns "20 rings bound no material in 3 of 20 layers, first at z = 0.25 mm (360 mm3 lost): they run
/// clockwise outside of material".
std::string inverted_text(const InvertedLayers& inverted, std::uint64_t layers,
                          std::span<const std::string> parts = {}) {
    const bool one = inverted.rings == 1;
    return fmt::format("{} no material {} ({:.4g} mm3 lost): {} clockwise outside of material",
                       counted(inverted.rings, "ring bounds", "rings bound"), where(inverted, layers, parts),
                       inverted.volume_mm3, one ? "it runs" : "they run");
}

/// The remedy for inverted rings in a file of layers.
constexpr const char* file_remedy = "; converting them with `fill` nonzero turns them round";

std::string power_of_ten_above(double length_mm);

/// Returns the likely cause of open chains with gaps of this length, and a remedy.
std::string open_gaps_text(double longest_mm) {
    // Larger than the rounding error between an edge of a triangle and a vertex of another triangle on this
    // edge.
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

/// Returns a value for an option that covers this length, such as "1e-5".
std::string power_of_ten_above(double length_mm) {
    constexpr double least = 1e-6; // smaller lengths are rounding errors
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

void InvertedLayers::add(double z, double thickness, const InvertedRings& found) noexcept {
    if (found.rings == 0)
        return;
    AffectedLayers::add(z);
    rings += found.rings;
    volume_mm3 += found.area_mm2 * thickness;
}

std::string InvertedLayers::text(std::uint64_t of_layers) const {
    return inverted_text(*this, of_layers);
}

std::string InvertedLayers::text_of_file(std::uint64_t of_layers) const {
    return text(of_layers) + file_remedy;
}

void UnreachedMaterial::add(double unreached_mm2, double z) noexcept {
    area_mm2 += unreached_mm2;
    if (unreached_mm2 > 0)
        AffectedLayers::add(z);
}

std::string UnreachedMaterial::text() const {
    return fmt::format("{:.4g} mm2 of material on {}, the lowest at z = {:.6g} mm, are reached by no vector: "
                       "it is too narrow for contours, for lines of hatches or for lines of thin walls. More "
                       "contours or smaller values of beam_offset, border, shortest or thinnest reach more; "
                       "accepted_mm2 of the strategy says how much of a layer may be left",
                       area_mm2, counted(layers, "layer"), first_z);
}

void LayerDoubts::add(double z, double thickness, const OpenGaps& gaps, const InvertedRings& found) noexcept {
    if (gaps.count > 0)
        open.add(z);
    open_gaps += gaps;
    inverted.add(z, thickness, found);
}

std::vector<std::string> LayerDoubts::texts() const {
    std::vector<std::string> texts;
    if (open_gaps.count > 0)
        texts.push_back(fmt::format("{} {}: {}", counted(open_gaps.count, "open chain"),
                                    where(open, layers, open_parts), open_gaps_text(open_gaps.longest_mm)));
    // If a mesh has holes, a closed contour may belong to a cavity whose surrounding contour is open.
    if (inverted.rings > 0)
        texts.push_back(inverted_text(inverted, layers, inverted_parts) +
                        (open_gaps.count > 0
                             ? "; contours around them stay open, or triangles face inwards"
                             : " because triangles face inwards; `orient` turns these round"));
    return texts;
}

std::vector<std::string> LayerDoubts::scan_losses(std::uint64_t hatches) const {
    std::vector<std::string> texts;
    if (hatches > 0)
        texts.push_back(fmt::format("{} left out: layers are hatched anew", counted(hatches, "hatch line")));
    if (open_gaps.count > 0)
        texts.push_back(fmt::format("{} left out {}: only closed contours bound material",
                                    counted(open_gaps.count, "open contour"),
                                    where(open, layers, open_parts)));
    if (inverted.rings > 0)
        texts.push_back(inverted_text(inverted, layers, inverted_parts) + file_remedy);
    return texts;
}

LayerDoubtSearch::LayerDoubtSearch(std::size_t planes, const Rounding& rounding, InversionSearch search,
                                   const Execution& execution, std::uint64_t max_memory)
    : planes_(planes), rounding_(rounding), search_(search),
      limits_(layer_limits(execution, max_memory, thread_count(execution))) {}

void LayerDoubtSearch::look_at(std::size_t position, const Layer& layer) {
    Plane& plane = planes_[position];
    plane.z = layer.z;
    plane.thickness = layer.thickness();
    plane.gaps += open_gaps(layer);
    plane.inverted += inverted_rings(layer, rounding_, search_, limits_);
}

void LayerDoubtSearch::look_at(std::size_t position, const LayerFile& file, const ScanVectors& plane) {
    for (std::size_t i = 0; i < file.parts.size(); ++i)
        if (!file.parts[i].exposure)
            look_at(position, plane.polylines[i]);
}

LayerDoubts LayerDoubtSearch::doubts() const {
    LayerDoubts doubts{.layers = planes_.size()};
    for (const Plane& plane : planes_)
        doubts.add(plane.z, plane.thickness, plane.gaps, plane.inverted);
    return doubts;
}

namespace {

/// Searches all planes; `look_at(search, position)` passes the layers of a plane.
template <class LookAt>
LayerDoubts searched(std::size_t planes, const Rounding& rounding, InversionSearch search,
                     const Execution& execution, std::uint64_t max_memory, const LookAt& look_at) {
    LayerDoubtSearch all(planes, rounding, search, execution, max_memory);
    Executor executor(execution);
    executor.for_chunks(planes, 1, [&](std::uint64_t i, std::uint64_t, unsigned) { look_at(all, i); });
    executor.check_cancelled();
    return all.doubts();
}

} // namespace

LayerDoubts layer_doubts(std::span<const LayerStack> parts, const Rounding& rounding, InversionSearch search,
                         const Execution& execution, std::uint64_t max_memory) {
    return searched(parts.empty() ? 0 : parts.front().size(), rounding, search, execution, max_memory,
                    [&](LayerDoubtSearch& all, std::size_t i) {
                        for (const LayerStack& part : parts)
                            all.look_at(i, part[i]);
                    });
}

LayerDoubts layer_doubts(const LayerFile& file, InversionSearch search, const Execution& execution,
                         std::uint64_t max_memory) {
    return searched(file.planes().size(), file.rounding, search, file.for_planes(execution), max_memory,
                    [&](LayerDoubtSearch& all, std::size_t i) { all.look_at(i, file, file.plane(i)); });
}

} // namespace lamella
