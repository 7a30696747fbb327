// Prints the section areas of a binary STL file of any size, one line for each layer: straight from the
// triangles, which stay in the file, without any of what slicing does.
//
//     stream_areas FILE LAYER_HEIGHT

#include <lamella/core/error.hpp>
#include <lamella/inputs/read_file.hpp>
#include <lamella/slicing/plan.hpp>
#include <lamella/slicing/slice.hpp>

#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
    using namespace lamella;
    if (argc != 3) {
        std::fputs("usage: stream_areas FILE LAYER_HEIGHT\n", stderr);
        return 2;
    }
    try {
        const MeshFile file = read_mesh(argv[1]);
        const Box3 box = bounding_box(file.mesh());
        const Plan plan = plan_uniform(box.min.z, box.max.z, {.layer_height = std::atof(argv[2])});
        for (const double area : section_areas(file.mesh(), plan))
            std::printf("%.17g\n", area);
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
