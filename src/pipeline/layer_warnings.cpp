#include "lamella/pipeline/layer_warnings.hpp"

#include "lamella/contour/measure.hpp"

#include "core/counted.hpp"

#include <fmt/format.h>

#include <cmath>

namespace lamella {
namespace {

/// "in 3 of 20 layers, first at z = 0.25 mm".
std::string where(const AffectedLayers& affected, std::uint64_t layers) {
    constexpr double nearly_0 = 1e-7; // what single precision leaves where 0 is meant
    const double z = std::abs(affected.first_z) < nearly_0 ? 0 : affected.first_z;
    return fmt::format("in {} of {}, first at z = {:.6g} mm", affected.layers, counted(layers, "layer"), z);
}

} // namespace

void AffectedLayers::add(double z) noexcept {
    if (layers++ == 0)
        first_z = z;
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
        texts.push_back(fmt::format("{} {}: contours do not close where the mesh has holes or flipped "
                                    "triangles, the longest gap is {:.6g} mm",
                                    counted(open_gaps.count, "open chain"), where(open, layers),
                                    open_gaps.longest_mm));
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
