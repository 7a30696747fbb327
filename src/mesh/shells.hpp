#pragma once

// The parts of a mesh that are connected over edges: their volumes, and which lies in which.

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

/// The n-th shell is the one whose first triangle comes n-th in the mesh.
struct Shells {
    PageArray<std::uint32_t> of_triangle; ///< no_shell for a degenerate triangle
    std::vector<std::uint32_t> first;     ///< triangle of each shell
    std::vector<bool> closed;             ///< every edge is used as often one way as the other

    [[nodiscard]] std::size_t size() const noexcept { return first.size(); }
};

[[nodiscard]] Shells find_shells(Executor& executor, const IndexedMesh& mesh, const EdgeSurvey& survey);

/// What the triangles of a shell bound together with an origin.
struct ShellContent {
    double six_volumes = 0; ///< signed
    double sizes = 0;       ///< of the summands of that, as far as rounding goes
    double triangles = 0;

    [[nodiscard]] double volume() const noexcept { return six_volumes / 6; }
    /// The volume has a sign that rounding did not give it.
    [[nodiscard]] bool certain() const noexcept { return std::abs(six_volumes) > rounding(); }
    /// A sum of k terms is off by no more than k epsilons of their sizes; 32 more are what one term rounds.
    [[nodiscard]] double rounding() const noexcept {
        return std::numeric_limits<double>::epsilon() * (triangles + 32) * sizes;
    }
    void add(const ShellContent& other) noexcept;

    friend auto operator<=>(const ShellContent&, const ShellContent&) = default;
};

/// Of every shell, measured from its own origin: near the shell, so that a small one far away keeps its sign.
/// Whether it is certain, and then which sign it has, depends neither on the order of triangles nor on which
/// corner of one comes first.
[[nodiscard]] std::vector<ShellContent> shell_contents(Executor& executor, const IndexedMesh& mesh,
                                                       const Shells& shells, std::span<const Point3> origins);

[[nodiscard]] std::vector<Box3> shell_boxes(const IndexedMesh& mesh, const Shells& shells);

/// Around a place on the surface of one shell, another winds so many times.
struct Enclosure {
    std::uint32_t shell;
    std::uint32_t encloser;
    int winding; ///< not 0

    friend auto operator<=>(const Enclosure&, const Enclosure&) = default;
};

/// Visits which shells lie around which, ascending; of the shells that asked(shell) says. A shell is judged
/// by the middle of its largest triangle: well away from edges where shells touch. Where many shells lie in
/// one another, the time grows with the square of their number, but memory does not.
void for_each_enclosure(Executor& executor, const IndexedMesh& mesh, const Shells& shells,
                        const std::vector<Box3>& boxes, const std::vector<bool>& asked,
                        const std::function<void(const Enclosure&)>& visit);

} // namespace lamella
