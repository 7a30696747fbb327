#include "pipeline/prescribed_lines.hpp"

#include "contour/distance.hpp"
#include "scan/hatch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>

namespace lamella {
namespace {

struct HatchLine {
    std::array<Point2, 2> ends = {};
    const HatchRule* rule = nullptr;
    std::uint64_t layer = 0;

    [[nodiscard]] double length() const noexcept { return distance(ends[0], ends[1]); }
};

/// Returns the longest line for each plane and rule with lines. Begins with the lowest plane and stops when
/// there are enough lines.
std::vector<HatchLine> longest_lines(const LayerFile& file, std::span<const ExposureGroup> groups,
                                     const ScanStrategy& strategy) {
    constexpr std::size_t enough = 32;
    std::vector<HatchLine> lines;
    for (std::size_t plane = 0; plane < file.planes().size() && lines.size() < enough; ++plane) {
        std::map<const HatchRule*, HatchLine> longest;
        const ScanVectors vectors = file.plane(plane);
        for (const ExposureGroup& group : groups)
            for (const PlaneExposure& part : on_plane(group, file, vectors)) {
                const HatchRule& rule = hatch_of(strategy, part.exposure.region);
                for (std::size_t i = 0; i + 1 < part.hatches.size(); i += 2)
                    if (const HatchLine line{
                            {part.hatches[i], part.hatches[i + 1]}, &rule, part.polylines.index};
                        line.length() > longest[&rule].length())
                        longest[&rule] = line;
            }
        for (const auto& of_rule : longest)
            if (of_rule.second.rule != nullptr)
                lines.push_back(of_rule.second);
    }
    return lines;
}

} // namespace

PrescribedLines::PrescribedLines(const HatchRule& rule, std::uint64_t layer, double tolerance)
    : distance_(rule.distance), phase_(line_phase(rule.pattern)), tolerance_(tolerance) {
    for (const CosSin& angle : line_angles(rule, layer))
        frames_.push_back({angle});
}

bool PrescribedLines::have(const Point2& a, const Point2& b) const {
    return std::any_of(frames_.begin(), frames_.end(), [&](const LineFrame& frame) {
        const double across = frame.across(a);
        const double v = (std::nearbyint(across / distance_ - phase_) + phase_) * distance_;
        return std::abs(across - v) <= tolerance_ && std::abs(frame.across(b) - v) <= tolerance_;
    });
}

std::uint64_t layers_below(const LayerFile& file, std::span<const ExposureGroup> groups,
                           const ScanStrategy& strategy, double tolerance, const Executor& executor) {
    const std::vector<HatchLine> lines = longest_lines(file, groups, strategy);
    constexpr std::uint64_t most = 1 << 17;
    std::uint64_t best = 0;
    std::ptrdiff_t most_fit = 0;
    for (std::uint64_t before = 0; before < most && most_fit < std::ssize(lines); ++before) {
        if (before % 1024 == 0)
            executor.check_cancelled();
        const auto fit = std::count_if(lines.begin(), lines.end(), [&](const HatchLine& line) {
            return PrescribedLines(*line.rule, before + line.layer, tolerance)
                .have(line.ends[0], line.ends[1]);
        });
        if (fit > most_fit) {
            most_fit = fit;
            best = before;
        }
    }
    return best;
}

} // namespace lamella
