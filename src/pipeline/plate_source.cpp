#include "pipeline/plate_source.hpp"

#include "lamella/core/error.hpp"
#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/mesh/inspect.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/slicing/varying_plan.hpp"

#include "core/executor.hpp"
#include "pipeline/plate_builder.hpp"
#include "pipeline/stopwatch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

namespace lamella {
namespace {

/// "2 boundary edges, 1 inverted shell".
std::string describe_defects(const Inspection& found) {
    struct Count {
        std::uint64_t n;
        std::string_view one;
        std::string_view many;
    };
    const std::array<Count, 6> counts{{
        {found.boundary_edges, "boundary edge", "boundary edges"},
        {found.nonmanifold_edges, "edge with more than two triangles", "edges with more than two triangles"},
        {found.orientation_conflicts, "orientation conflict", "orientation conflicts"},
        {found.duplicate_triangles, "duplicate triangle", "duplicate triangles"},
        {found.degenerate_triangles, "degenerate triangle", "degenerate triangles"},
        {found.inverted_shells, "inverted shell", "inverted shells"},
    }};
    std::string text;
    for (const Count& count : counts)
        if (count.n != 0)
            text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count.n,
                                count.n == 1 ? count.one : count.many);
    return text;
}

/// The counts of all parts, each of which is a solid of its own.
Inspection together(const Plate& plate, const std::vector<Inspection>& shapes) {
    Inspection all;
    for (const PlatePart& part : plate.parts) {
        const Inspection& one = shapes[part.shape];
        all.box.add(part.box);
        all.volume_mm3 += one.volume_mm3;
        all.area_mm2 += one.area_mm2;
        all.triangles += one.triangles;
        all.vertices += one.vertices;
        all.boundary_edges += one.boundary_edges;
        all.nonmanifold_edges += one.nonmanifold_edges;
        all.orientation_conflicts += one.orientation_conflicts;
        all.duplicate_triangles += one.duplicate_triangles;
        all.degenerate_triangles += one.degenerate_triangles;
        all.shells += one.shells;
        all.cavities += one.cavities;
        all.inverted_shells += one.inverted_shells;
    }
    return all;
}

/// Inspects every shape, and leaves it welded for an engine that would weld it once more.
Inspection inspect_plate(Plate& plate, bool keep_welded, bool strict, const Execution& execution) {
    std::vector<Inspection> found;
    for (PlateShape& shape : plate.shapes) {
        IndexedMesh welded = weld(shape.mesh, execution);
        found.push_back(inspect(welded, execution));
        if (strict && !found.back().sound())
            throw Error(ErrorKind::defect,
                        fmt::format("{}: the mesh has defects: {}", plate.files[shape.input].path,
                                    describe_defects(found.back())));
        if (keep_welded)
            shape.mesh = Mesh(std::move(welded));
    }
    return together(plate, found);
}

/// Files of indexed meshes need not share the vertices that are equal; contours would end between them.
void join_vertices(Plate& plate, const Execution& execution) {
    for (PlateShape& shape : plate.shapes)
        if (shape.mesh.indexed() != nullptr)
            shape.mesh = Mesh(weld(*shape.mesh.indexed(), execution));
}

bool has_indexed(const Plate& plate) {
    return std::ranges::any_of(plate.shapes,
                               [](const PlateShape& shape) { return shape.mesh.indexed() != nullptr; });
}

void repair_plate(Plate& plate, const RepairPolicies& policies, FileResult& result,
                  const Execution& execution) {
    for (PlateShape& shape : plate.shapes) {
        FileResult::MeshRepair& done = result.repairs.emplace_back();
        done.file = shape.input;
        shape.mesh = repaired(shape.mesh, policies, done.repairs, execution);
        if (shape.mesh.empty())
            throw Error(ErrorKind::input, fmt::format("{}: nothing of the mesh is left after its repair",
                                                      plate.files[shape.input].path));
    }
}

class PlateSource final : public LayerSource {
  public:
    PlateSource(Plate plate, std::uint64_t points_in_flight) : points_in_flight_(points_in_flight) {
        plate_ = std::move(plate);
    }

    [[nodiscard]] std::uint64_t triangles(std::size_t shape) const override {
        return plate_.shapes[shape].mesh.size();
    }

    [[nodiscard]] Plan adaptive_plan(const AdaptiveLayers& layers, const Execution& execution) override {
        return plan_adaptive(joined(plate_, execution), layers, execution);
    }

    [[nodiscard]] PlaneCounts counts(const Plan& plan, const Execution& execution) override {
        PlaneCounts sum(plan.layers.size());
        for (const PlatePart& part : plate_.parts)
            sum.add(count_planes(plate_.shapes[part.shape].mesh, plan, execution));
        return sum;
    }

    void prepare(const FileJob& job, const Engine& with, FileResult& result,
                 const Execution& execution) override {
        const Stopwatch welding;
        const bool inspected = job.inspect || job.strict;
        const bool indexed = has_indexed(plate_);
        if (indexed)
            join_vertices(plate_, execution);
        if (inspected)
            result.inspection = inspect_plate(plate_, with.welds, job.strict, execution);
        if (indexed || inspected)
            result.seconds.weld = welding.seconds();
        if (job.layer_statistics)
            for (const PlatePart& part : plate_.parts)
                result.mesh_volume_mm3 += volume(plate_.shapes[part.shape].mesh, execution);
        if (job.repair.change_the_mesh()) {
            const Stopwatch repairing;
            repair_plate(plate_, job.repair, result, execution);
            result.seconds.weld += repairing.seconds();
        }
    }

    void slice_to(const PlateSink& sink, const Plan& plan, const Execution& execution, FileResult& result,
                  const Engine& with) override {
        slice_plate_to(sink, plate_, plan, execution, result.report, with, points_in_flight_);
    }

  private:
    std::uint64_t points_in_flight_;
};

/// Of a mesh that cannot be sliced in pieces.
void check_size(const std::string& path, const Mesh& mesh, const JobMemory& memory, unsigned threads) {
    const std::uint64_t bytes = memory.of_mesh(mesh, threads);
    if (bytes > memory.limit)
        throw Error(
            ErrorKind::limit,
            fmt::format("{}: to slice its {} triangles takes up to {} MB of memory, above the {} MB of "
                        "--max-memory; only STL files that are not packed are sliced in pieces: write "
                        "the mesh as one, or allow more",
                        path, mesh.size(), bytes / 1'000'000 + 1, memory.limit / 1'000'000));
}

} // namespace

std::unique_ptr<LayerSource> open_plate_source(const FileJob& job, std::vector<MeshInput> files,
                                               const JobMemory& memory, const Execution& execution) {
    const MeshReadOptions options{
        .strict = job.strict, .max_triangles = job.max_triangles, .max_memory = job.max_memory};
    const unsigned threads = thread_count(execution);
    std::vector<MeshFile> meshes;
    for (MeshInput& file : files) {
        const MeshInput input = std::move(file); // a text is let go of once it is read
        const bool stl = input.can_stream();
        meshes.push_back(input.read(options, execution));
        if (memory.asked && !stl)
            for (const MeshObject& object : meshes.back().objects)
                check_size(input.path(), object.mesh, memory, threads);
    }
    return plate_source(build_plate(job.inputs, std::move(meshes), execution), memory, execution);
}

std::unique_ptr<LayerSource> plate_source(Plate plate, const JobMemory& memory, const Execution& execution) {
    return std::make_unique<PlateSource>(std::move(plate), memory.points_in_flight(thread_count(execution)));
}

} // namespace lamella
