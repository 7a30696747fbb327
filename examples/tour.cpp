// The whole library in a hundred lines, one step per group of lamella/jobs.hpp, in its order.
#include <lamella/jobs.hpp>

#include <iostream>
#include <new>
#include <utility>
#include <vector>

using namespace lamella;

namespace {

/// Returns a box in which one triangle is missing and another one is flipped.
IndexedMesh torn_box(double x, double y, double z) {
    return {{{0, 0, 0}, {x, 0, 0}, {x, y, 0}, {0, y, 0}, {0, 0, z}, {x, 0, z}, {x, y, z}, {0, y, z}},
            {{0, 2, 1},
             {0, 3, 2},
             {4, 5, 6},
             {4, 6, 7},
             {0, 1, 5},
             {0, 5, 4},
             {1, 2, 6},
             {1, 6, 5},
             {2, 3, 7},
             {2, 7, 6},
             {3, 4, 0}}};
}

void tour() {
    // All long computations take an Execution: number of threads, progress and cancellation. The result never
    // depends on it.
    Execution execution;
    execution.threads = 2;

    // Meshes come from arrays or from files, as single triangles or with shared vertices.
    write_obj("box.obj", torn_box(20, 10, 5), "box");
    const MeshFile file = read_mesh("box.obj", {}, execution);
    std::cout << file.path << ": " << file.format << ", " << file.mesh().size() << " triangles\n";

    // Find the defects of the mesh. Nothing is repaired unless requested, and repairs report their changes.
    const IndexedMesh welded = weld(file.mesh(), execution);
    const Inspection found = inspect(welded, execution);
    for (const DefectKind& kind : defect_kinds)
        if (found.*kind.count != 0)
            std::cout << "  " << found.*kind.count << " " << kind.words.many << ": " << kind.words.meaning
                      << "\n";
    const OrientedMesh oriented = orient(welded, execution);
    std::cout << "  " << oriented.flipped_triangles << " triangle flipped\n";

    // Place the mesh, plan the layers and slice it.
    const Mesh mesh = Mesh(oriented.mesh).transformed(compose(translation(100, 50, 0), rotation('z', 30)));
    const Box3 box = bounding_box(mesh);
    const Plan plan = plan_uniform(box.min.z, box.max.z, {.layer_height = 0.5});
    LayerStack layers = slice(mesh, plan, {.execution = execution});

    // The hole in the mesh leaves contours open; gaps that are small enough are closed.
    for (Layer& layer : layers) {
        ClosedGaps closed = close_gaps(layer, 12);
        layer = std::move(closed.layer);
    }

    // Examine a layer. A contour is a span of points with material on its left.
    const Layer& layer = layers[4];
    const std::vector<Polygon> bodies = polygons(nesting(layer));
    std::cout << "at z = " << layer.z << " mm: " << layer.contours() << " contours, " << bodies.size()
              << " bodies, " << measure(layer).area_mm2 << " mm2, "
              << (has_crossings(layer) ? "crossing" : "not crossing") << " itself\n";

    // Process a layer.
    const Filled filled = fill(layer, FillRule::nonzero);
    const Layer smaller = offset(filled.layer, -1);
    std::cout << "  1 mm inwards: " << measure(smaller).area_mm2 << " mm2, corners "
              << compare(layer, smaller).distance_mm << " mm away\n";
    const PixelGrid grid{.width = 64, .height = 48, .ux = 2, .u0 = -184, .vy = 2, .v0 = -96};
    const GreyImage image = paint({&layer, 1}, grid);
    std::cout << "  an image of " << image.width << " x " << image.height << " pixels\n";

    // The name of a format selects the writer, the content of a file the reader. Then check that the layers
    // are sound and what volume they have.
    write_layers("box.cli", layers);
    const LayerFile again = read_layers("box.cli");
    const Verification checked = verify(again.merged(), {.rounding = again.rounding}, execution);
    std::cout << again.path << ": " << checked.layers << " layers, " << checked.volume_mm3 << " mm3, "
              << (checked.ok() ? "sound" : "with defects") << "\n";

    // All steps in one call, layer by layer in bounded memory: several meshes of any size.
    write_obj("oriented.obj", oriented.mesh, "oriented");
    FileJob job;
    job.inputs = {{.path = "oriented.obj", .copies = 2}};
    job.layering.cut = UniformLayers{.layer_height = 0.5};
    job.repair.close_gaps_mm = 12;
    job.layer_statistics = true;
    job.output = "plate.svg";
    const FileResult result = slice_file(job, execution);
    std::cout << job.output << ": " << result.layers.size() << " layers of " << result.parts.size()
              << " parts, " << std::hex << file_hash(job.output) << " on every machine\n";
}

} // namespace

int main() {
    try {
        tour();
    } catch (const Error& error) { // its kind helps the caller to decide
        std::cerr << error.what() << "\n";
        return 1;
    } catch (const std::bad_alloc& error) { // the only other exception: memory ran out
        std::cerr << error.what() << "\n";
        return 1;
    }
}
