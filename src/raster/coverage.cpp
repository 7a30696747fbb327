#include "raster/coverage.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lamella {

// A row consists of single edges that pass from its upper to its lower border, and of knots: groups of
// adjacent edges with corners, crossings, or upper and lower ends of contours. Between two of these the
// winding number is constant, so each can be drawn independently. A knot is divided into strips at its
// corners and crossings. Within a strip the order of edges is constant, so coverage is an exact sum over the
// edges that bound material.

namespace {

/// Gaps between two bodies up to this width, in pixels, are attributed to rounding of their common border.
constexpr double most_rounding = 1e-6;

} // namespace

RowPiece::RowPiece(const ImageEdge& edge, std::uint32_t row) noexcept {
    const bool begins = edge.upper.y >= row;
    top = begins ? edge.upper.y : row;
    reach(edge, row, begins ? edge.upper.x : edge.column(row));
}

void RowPiece::move_to(const ImageEdge& edge, std::uint32_t row) noexcept {
    top = row;
    reach(edge, row, bottom == row ? bottom_column : edge.column(row));
}

void RowPiece::reach(const ImageEdge& edge, std::uint32_t row, double top_column) noexcept {
    const double border = row + 1.0;
    const bool ends = edge.lower.y <= border;
    bottom = ends ? edge.lower.y : border;
    bottom_column = ends ? edge.lower.x : edge.column(border);
    low = std::min(top_column, bottom_column);
    high = std::max(top_column, bottom_column);
    through = top == row && bottom == border;
    if (low <= 0) {
        low = left_of_image;
        high = std::max(high, low);
    }
}

DrawnRow CoverageRows::draw(std::uint32_t row) {
    const std::uint32_t times = cover(row);
    const std::span<const PixelRun> runs = coverage_.take(0);
    return {runs, coverage_.covered(), times, coverage_.unseen() * times};
}

std::uint32_t CoverageRows::cover(std::uint32_t row) {
    if (pieces_.entries().empty() && pieces_.next_begin() > row)
        return pieces_.next_begin() - row;
    pieces_.advance(row);
    const Pieces pieces = pieces_.entries();
    int winding = 0;
    bool upright = true;
    std::size_t begin = 0;
    while (begin < pieces.size() && pieces[begin].low < width_) {
        double high = pieces[begin].high;
        int right = winding;
        std::size_t end = begin;
        do {
            const auto& piece = pieces[end];
            high = std::max(high, piece.high);
            if (piece.bottom == row + 1.0)
                right += pieces_.edge(piece).winding;
            upright = upright && piece.through && pieces_.edge(piece).slope == 0;
        } while (++end < pieces.size() && pieces[end].low <= high + most_rounding);

        const bool alone = end == begin + 1 && pieces[begin].through && pieces[begin].low > 0;
        if (!alone)
            draw_knot(pieces.subspan(begin, end - begin), winding, row);
        else if ((winding == 0) != (right == 0))
            coverage_.begin_along(0, pieces[begin].low, pieces[begin].high, right != 0 ? 1 : -1);
        winding = right;
        begin = end;
    }
    upright = upright && begin == pieces.size(); // otherwise edges to the right may approach in later rows
    return upright ? pieces_.same_edges_until() - row : 1;
}

void CoverageRows::draw_knot(Pieces knot, int left, std::uint32_t row) {
    if (draw_line(knot, left, row))
        return;
    if (find_strips(knot, row)) {
        for (std::size_t i = 1; i < heights_.size(); ++i)
            draw_strip(knot, left, heights_[i - 1], heights_[i]);
        return;
    }
    const double strips = strips_;
    for (unsigned i = 0; i < strips_; ++i)
        draw_strip(knot, left, row + i / strips, row + (i + 1) / strips);
}

bool CoverageRows::draw_line(Pieces knot, int left, std::uint32_t row) {
    line_.clear();
    int winding = 0;
    for (const auto& piece : knot) {
        const ImageEdge& edge = pieces_.edge(piece);
        if (edge.level())
            continue; // a horizontal step of the line
        if (winding != 0 && winding != edge.winding)
            return false; // the line changes direction, or there are two
        winding = edge.winding;
        line_.push_back({piece.top, piece.bottom, &edge});
    }
    // A line that runs to the left throughout is stored in reverse order.
    if (line_.size() > 1 && line_.front().top > line_.back().top)
        std::reverse(line_.begin(), line_.end());
    const auto higher = [](const LinePiece& a, const LinePiece& b) {
        return a.top < b.top;
    };
    if (!std::is_sorted(line_.begin(), line_.end(), higher))
        std::sort(line_.begin(), line_.end(), higher);
    double reached = row;
    for (const LinePiece& piece : line_) {
        const double middle = 0.5 * (piece.top + piece.bottom);
        if (piece.top != reached || !(piece.top < middle && middle < piece.bottom))
            // There are gaps or other edges, or an edge is lower than numbers can resolve.
            return false;
        reached = piece.bottom;
    }
    if (reached != row + 1.0)
        return false;
    const int right = left + winding;
    if ((left == 0) == (right == 0))
        return true;
    for (const LinePiece& piece : line_) {
        const double height = piece.bottom - piece.top;
        draw_border(*piece.edge, piece.edge->column(0.5 * (piece.top + piece.bottom)), height,
                    left == 0 ? height : -height);
    }
    return true;
}

bool CoverageRows::find_strips(Pieces knot, std::uint32_t row) {
    const std::size_t most = std::size_t{strips_} + 2;
    if (knot.size() > 2 * most)
        return false;
    heights_.assign({static_cast<double>(row), row + 1.0});
    for (const auto& piece : knot) {
        for (const double height : {piece.top, piece.bottom})
            if (std::find(heights_.begin(), heights_.end(), height) == heights_.end())
                heights_.push_back(height);
    }
    for (std::size_t a = 0; a < knot.size() && heights_.size() <= most; ++a)
        for (std::size_t b = a + 1; b < knot.size() && knot[b].low <= knot[a].high; ++b)
            add_crossing(knot[a], pieces_.edge(knot[a]), knot[b], pieces_.edge(knot[b]));
    std::sort(heights_.begin(), heights_.end());
    return heights_.size() <= most;
}

void CoverageRows::add_crossing(const RowPiece& a, const ImageEdge& edge_a, const RowPiece& b,
                                const ImageEdge& edge_b) {
    const double from = std::max(a.top, b.top);
    const double to = std::min(a.bottom, b.bottom);
    if (from >= to)
        return;
    const double above = edge_a.column(from) - edge_b.column(from);
    const double below = edge_a.column(to) - edge_b.column(to);
    if ((above < 0 && below > 0) || (above > 0 && below < 0))
        heights_.push_back(from + (to - from) * (above / (above - below)));
}

void CoverageRows::draw_border(const ImageEdge& edge, double middle_column, double height, double weight) {
    const auto [low, high] = std::minmax(edge.upper.x, edge.lower.x);
    const double half =
        std::min({0.5 * std::abs(height * edge.slope), middle_column - low, high - middle_column});
    coverage_.begin_along(0, middle_column - half, middle_column + half, weight);
}

void CoverageRows::draw_strip(Pieces knot, int left, double from, double to) {
    const double middle = 0.5 * (from + to);
    borders_.clear();
    for (const auto& piece : knot) {
        if (piece.top <= middle && middle < piece.bottom) {
            const ImageEdge& edge = pieces_.edge(piece);
            borders_.push_back({edge.column(middle), &edge});
        }
    }
    std::sort(borders_.begin(), borders_.end(), [](const Border& a, const Border& b) {
        return a.column != b.column ? a.column < b.column : a.edge < b.edge;
    });
    const double height = to - from;
    int winding = left;
    const Border* end = nullptr; // the end of material, unless further material begins there
    for (const Border& border : borders_) {
        const int before = std::exchange(winding, winding + border.edge->winding);
        if (before == 0) {
            if (end != nullptr && border.column - end->column > most_rounding) {
                draw_border(*end->edge, end->column, height, -height);
                end = nullptr;
            }
            if (end == nullptr)
                draw_border(*border.edge, border.column, height, height);
            end = nullptr;
        } else if (winding == 0) {
            end = &border;
        }
    }
    if (end != nullptr)
        draw_border(*end->edge, end->column, height, -height);
}

} // namespace lamella
