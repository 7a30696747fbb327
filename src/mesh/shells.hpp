#pragma once

// The connected components of a mesh, their volumes and their nesting.

#include "lamella/mesh/indexed_mesh.hpp"

#include "core/executor.hpp"
#include "core/pages.hpp"
#include "mesh/edge_survey.hpp"

#include <cmath>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

namespace lamella {

constexpr std::uint32_t no_shell = 0xffffffff;

/// Shells are numbered in the order of their first triangles in the mesh.
struct Shells {
    PageArray<std::uint32_t> of_triangle; ///< no_shell for a degenerate triangle
    std::vector<std::uint32_t> first;     ///< first triangle of each shell
    std::vector<bool> closed;             ///< every edge is used equally often in both directions

    [[nodiscard]] std::size_t size() const noexcept { return first.size(); }
};

[[nodiscard]] Shells find_shells(Executor& executor, const IndexedMesh& mesh, const EdgeSurvey& survey);

/// The signed volume between the triangles of a shell and an origin.
struct ShellContent {
    double six_volumes = 0; ///< signed
    double sizes = 0;       ///< sum of the absolute values of all terms, for the bound on rounding errors
    double triangles = 0;

    [[nodiscard]] double volume() const noexcept { return six_volumes / 6; }
    /// Returns true if rounding cannot have changed the sign of the volume.
    [[nodiscard]] bool certain() const noexcept { return std::abs(six_volumes) > rounding(); }
    /// A sum of k terms has an error of at most k epsilon times `sizes`; the rounding of each term adds up to
    /// 32 epsilon times `sizes`.
    [[nodiscard]] double rounding() const noexcept {
        return std::numeric_limits<double>::epsilon() * (triangles + 32) * sizes;
    }
    void add(const ShellContent& other) noexcept;

    friend auto operator<=>(const ShellContent&, const ShellContent&) = default;
};

/// Measures every shell from its own origin near the shell, so that the sign of a small shell far away is
/// correct. Neither certain() nor a certain sign depends on the order of triangles or on their first corners.
[[nodiscard]] std::vector<ShellContent> shell_contents(Executor& executor, const IndexedMesh& mesh,
                                                       const Shells& shells, std::span<const Point3> origins);

[[nodiscard]] std::vector<Box3> shell_boxes(const IndexedMesh& mesh, const Shells& shells);

/// A pair of shells: the encloser winds around a point on the surface of the other shell.
struct Enclosure {
    std::uint32_t shell;
    std::uint32_t encloser;
    int winding; ///< winding number of the encloser around the point, not 0

    friend auto operator<=>(const Enclosure&, const Enclosure&) = default;
};

/// Visits, for each shell in `asked`, the shells that enclose it, in ascending order. The centroid of the
/// largest triangle represents a shell: it is well away from edges where shells touch. For many nested
/// shells, time grows with the square of their number, but memory does not.
void for_each_enclosure(Executor& executor, const IndexedMesh& mesh, const Shells& shells,
                        const std::vector<Box3>& boxes, const std::vector<bool>& asked,
                        const std::function<void(const Enclosure&)>& visit);

} // namespace lamella
