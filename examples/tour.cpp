// The whole library in a hundred lines, in the order of its door, lamella/lamella.hpp: a step of each group.
#include <lamella/lamella.hpp>

#include <iostream>
#include <new>
#include <utility>
#include <vector>

using namespace lamella;

namespace {

/// A box without one of its triangles, and with one that runs the wrong way round.
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
    // All long computations take an Execution: how many threads, who hears of progress, who may end it. The
    // result never depends on it.
    Execution execution;
    execution.threads = 2;

    // Meshes come from arrays or from any file, as single triangles or with vertices that they share.
    write_obj("box.obj", torn_box(20, 10, 5), "box");
    const MeshFile file = read_mesh("box.obj", {}, execution);
    std::cout << file.path << ": " << file.format << ", " << file.mesh().size() << " triangles\n";

    // What is wrong with it? Nothing is repaired unasked, and what repairs did is told.
    const IndexedMesh welded = weld(file.mesh(), execution);
    const Inspection found = inspect(welded, execution);
    for (const DefectKind& kind : defect_kinds)
        if (found.*kind.count != 0)
            std::cout << "  " << found.*kind.count << " " << kind.words.many << ": " << kind.words.meaning
                      << "\n";
    const OrientedMesh oriented = orient(welded, execution);
    std::cout << "  " << oriented.turned_triangles << " triangle turned round\n";

    // To its place; then the planes, and the layers at all of them.
    const Mesh mesh = Mesh(oriented.mesh).transformed(compose(translation(100, 50, 0), rotation('z', 30)));
    const Box3 box = bounding_box(mesh);
    const Plan plan = plan_uniform(box.min.z, box.max.z, {.layer_height = 0.5});
    LayerStack layers = slice(mesh, plan, execution);

    // Where the mesh has its hole, contours stay open; they are closed where the gap is small enough.
    for (Layer& layer : layers) {
        ClosedGaps closed = close_gaps(layer, 12);
        layer = std::move(closed.layer);
    }

    // What can be asked of a layer. A contour is a span of points, the material on its left.
    const Layer& layer = layers[4];
    const std::vector<Polygon> bodies = polygons(nesting(layer));
    std::cout << "at z = " << layer.z << " mm: " << layer.contours() << " contours, " << bodies.size()
              << " bodies, " << measure(layer).area_mm2 << " mm2, "
              << (has_crossings(layer) ? "crossing" : "not crossing") << " itself\n";

    // What can be made of it.
    const Filled filled = fill(layer, FillRule::nonzero);
    const Layer smaller = offset(filled.layer, -1);
    std::cout << "  1 mm inwards: " << measure(smaller).area_mm2 << " mm2, corners "
              << compare(layer, smaller).distance_mm << " mm away\n";
    const PixelGrid grid{.width = 64, .height = 48, .ux = 2, .u0 = -184, .vy = 2, .v0 = -96};
    const GreyPicture picture = paint({&layer, 1}, grid);
    std::cout << "  a picture of " << picture.width << " x " << picture.height << " pixels\n";

    // Files of layers are written by the name of their format and read by their content. Then: is all of it
    // sound, and as large as the mesh says?
    write_layers("box.cli", layers);
    const LayerFile again = read_layers("box.cli");
    const Verification checked = verify(again.merged(), {.rounding = again.rounding}, execution);
    std::cout << again.path << ": " << checked.layers << " layers, " << checked.volume_mm3 << " mm3, "
              << (checked.ok() ? "sound" : "with defects") << "\n";

    // The whole way in one call, layer by layer in bounded memory: meshes of any size, several of them.
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
    } catch (const Error& error) { // its kind says what a caller can do about it
        std::cerr << error.what() << "\n";
        return 1;
    } catch (const std::bad_alloc& error) { // the only other one: memory ran out
        std::cerr << error.what() << "\n";
        return 1;
    }
}
