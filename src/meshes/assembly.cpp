#include "meshes/assembly.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"

#include "container/plain_values.hpp"
#include "container/read_limits.hpp"
#include "core/counted.hpp"
#include "core/executor.hpp"
#include "mesh/singular.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <functional>
#include <limits>

namespace lamella {

namespace {

constexpr int deepest = 64;
constexpr std::uint64_t most_instances = std::uint64_t{1} << 20;
constexpr std::uint64_t instance_bytes = 1024; ///< including the data that the plate stores for it

std::uint64_t sum(std::uint64_t a, std::uint64_t b) {
    return a > std::numeric_limits<std::uint64_t>::max() - b ? std::numeric_limits<std::uint64_t>::max()
                                                             : a + b;
}

class Placer {
  public:
    Placer(const std::string& file_name, std::span<const AssemblyNode> nodes,
           std::span<const MeshObject> objects, ReadLimits& limits, Executor& executor)
        : file_name_(file_name), nodes_(nodes), objects_(objects), limits_(limits), executor_(executor),
          totals_(nodes.size()) {}

    std::vector<MeshInstance> place(std::span<const AssemblyUse> roots) {
        for (std::size_t node = 0; node < nodes_.size(); ++node)
            total(node, 0); // finds cycles even if no root leads to them
        Total all;
        for (const AssemblyUse& root : roots)
            all.add(total(root.node, 0));
        if (all.instances > most_instances)
            throw Error(ErrorKind::limit,
                        fmt::format("{}: puts {}{} meshes on the plate, at most {} are taken", file_name_,
                                    all.instances + 1 == 0 ? "more than " : "", all.instances,
                                    most_instances));
        limits_.check_triangles(all.triangles);
        limits_.add_bytes_at(all.instances * instance_bytes, [&] {
            return fmt::format("{} meshes that are put on the plate", all.instances);
        });
        instances_.reserve(all.instances);
        reaches_.resize(objects_.size());
        for (const AssemblyNode& node : nodes_)
            filled_.push_back(filled(node.uses));
        for (const AssemblyUse* root : filled(roots))
            put(*root, {}, "", MeshRole::part, bodies_++);
        assert(instances_.size() == all.instances);
        return std::move(instances_);
    }

  private:
    enum class State { unknown, open, known };

    /// The contents of one use of a node. Sums saturate at the largest number.
    struct Total {
        State state = State::unknown;
        std::uint64_t instances = 0;
        std::uint64_t triangles = 0;

        void add(const Total& other) {
            instances = sum(instances, other.instances);
            triangles = sum(triangles, other.triangles);
        }
    };

    const Total& total(std::size_t index, int depth) {
        const AssemblyNode& node = nodes_[index];
        Total& known = totals_[index];
        if (known.state == State::known)
            return known;
        if (known.state == State::open)
            fail(node.location, "contains itself");
        if (depth > deepest)
            fail(node.location, fmt::format("is nested deeper than {}", deepest));
        known.state = State::open;
        Total result;
        for (const AssemblyMesh& mesh : node.meshes) {
            assert(mesh.object < objects_.size());
            result.add({State::known, 1, objects_[mesh.object].mesh.size()});
        }
        for (const AssemblyUse& use : node.uses) {
            assert(use.node < nodes_.size());
            result.add(total(use.node, depth + 1));
        }
        result.state = State::known;
        known = result;
        return known;
    }

    /// Returns the uses that lead to a mesh. The others are skipped once, not for each instance.
    [[nodiscard]] std::vector<const AssemblyUse*> filled(std::span<const AssemblyUse> uses) const {
        std::vector<const AssemblyUse*> result;
        for (const AssemblyUse& use : uses)
            if (totals_[use.node].instances != 0)
                result.push_back(&use);
        return result;
    }

    // Depth is checked again, because a node that was counted at one depth may also be used at a greater one.
    void put(const AssemblyUse& use, const Transform& outer, const std::string& name, MeshRole outer_role,
             std::uint64_t body, int depth = 0) {
        const AssemblyNode& node = nodes_[use.node];
        if (depth > deepest)
            fail(node.location, fmt::format("is nested deeper than {}", deepest));
        const Transform placement = compose(outer, use.placement);
        const std::string& nearest = node.name.empty() ? name : node.name;
        const MeshRole role = use.role != MeshRole::part ? use.role : outer_role;
        if (node.is_body)
            body = bodies_++;
        for (const AssemblyMesh& mesh : node.meshes) {
            executor_.check_cancelled();
            const MeshRole its = mesh.role != MeshRole::part ? mesh.role : role;
            MeshInstance instance{mesh.object,
                                  compose(placement, node.unit),
                                  nearest,
                                  its == MeshRole::support,
                                  its == MeshRole::negative,
                                  body};
            check_reach(instance, use.position);
            instances_.push_back(std::move(instance));
        }
        for (const AssemblyUse* inner : filled_[use.node])
            put(*inner, placement, nearest, role, body, depth + 1);
    }

    void check_reach(const MeshInstance& instance, const UsePosition& position) {
        auto& reach = reaches_[instance.object];
        if (!reach) {
            const Box3 box = bounding_box(objects_[instance.object].mesh);
            reach.emplace();
            const auto largest = [](double low, double high) {
                return std::max(std::abs(low), std::abs(high));
            };
            if (!box.empty())
                *reach = {largest(box.min.x, box.max.x), largest(box.min.y, box.max.y),
                          largest(box.min.z, box.max.z)};
        }
        const Transform& map = instance.placement;
        for (std::size_t row = 0; row < 3; ++row) {
            double furthest = std::abs(map.offset[row]);
            for (std::size_t axis = 0; axis < 3; ++axis)
                furthest += std::abs(map.linear[row][axis]) * (*reach)[axis];
            if (!(furthest <= farthest_coordinate) || !finite(map))
                fail(position.text(),
                     fmt::format("puts a mesh further away than {} mm", farthest_coordinate));
        }
        if (singular(map))
            fail(position.text(), "flattens a mesh");
    }

    [[noreturn]] void fail(const std::string& location, const std::string& what) const {
        throw Error(ErrorKind::input, fmt::format("{}, {}: {}", file_name_, location, what));
    }

    const std::string& file_name_;
    std::span<const AssemblyNode> nodes_;
    std::span<const MeshObject> objects_;
    ReadLimits& limits_;
    Executor& executor_;
    std::vector<Total> totals_;
    std::vector<std::vector<const AssemblyUse*>> filled_; ///< of each node: the uses that lead to a mesh
    std::vector<std::optional<std::array<double, 3>>> reaches_; ///< largest coordinates of each mesh
    std::vector<MeshInstance> instances_;
    std::uint64_t bodies_ = 0;
};

} // namespace

std::string UsePosition::text() const {
    const std::string at = fmt::format("line {}: {}", line, what);
    return part.empty() ? at : fmt::format("part '{}', {}", excerpt(part), at);
}

void count_assembly(std::size_t nodes, std::size_t uses, ReadLimits& limits) {
    constexpr std::uint64_t of_place = 64; // the text of AssemblyNode::location
    limits.add_bytes_at(nodes * (sizeof(AssemblyNode) + of_place) + uses * sizeof(AssemblyUse),
                        [&] { return fmt::format("{} uses of {}", uses, counted(nodes, "object")); });
}

bool all_negative(std::span<const MeshInstance> instances) {
    return std::all_of(instances.begin(), instances.end(), std::mem_fn(&MeshInstance::negative));
}

std::vector<MeshInstance> place_meshes(const std::string& file_name, std::span<const AssemblyNode> nodes,
                                       std::span<const AssemblyUse> roots,
                                       std::span<const MeshObject> objects, ReadLimits& limits,
                                       Executor& executor) {
    return Placer(file_name, nodes, objects, limits, executor).place(roots);
}

} // namespace lamella
