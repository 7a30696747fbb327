#include "raster/centres.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lamella {

namespace {

/// The first row whose centres do not lie above v.
std::uint32_t row_of_centres(double v, std::uint32_t height) noexcept {
    return static_cast<std::uint32_t>(std::clamp(std::ceil(v - 0.5), 0.0, static_cast<double>(height)));
}

/// The first column of such a row.
std::uint32_t column_of_centres(double u) noexcept {
    return static_cast<std::uint32_t>(std::clamp(std::ceil(u - 0.5), 0.0, static_cast<double>(most_pixels)));
}

} // namespace

RowRange CentreCrossing::rows(const PictureEdge& edge, std::uint32_t height) noexcept {
    return {row_of_centres(edge.upper.y, height), row_of_centres(edge.lower.y, height)};
}

std::uint32_t CentreRows::draw(std::uint32_t row, CoverageRow& out) {
    if (crossings_.entries().empty() && crossings_.next_begin() > row)
        return crossings_.next_begin() - row;
    crossings_.advance(row);
    int winding = 0;
    bool upright = true;
    for (const auto& crossing : crossings_.entries()) {
        const PictureEdge& edge = crossings_.edge(crossing);
        const int left = std::exchange(winding, winding + edge.winding);
        if ((left == 0) != (winding == 0))
            out.begin_at(column_of_centres(crossing.column), left == 0 ? 1 : -1);
        upright = upright && edge.slope == 0;
    }
    return upright ? crossings_.same_edges_until() - row : 1;
}

} // namespace lamella
