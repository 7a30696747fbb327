// Prints the section areas of an STL file of any size, one line for each layer: straight from the triangles,
// batch by batch, without any of what slicing does.
//
//     stream_areas FILE LAYER_HEIGHT

#include <lamella/core/error.hpp>
#include <lamella/read/mesh_input.hpp>
#include <lamella/slicing/plan.hpp>
#include <lamella/slicing/section_sum.hpp>

#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <vector>

int main(int argc, char** argv) {
    using namespace lamella;
    if (argc != 3) {
        std::fputs("usage: stream_areas FILE LAYER_HEIGHT\n", stderr);
        return 2;
    }
    try {
        const MeshInput input(argv[1]);
        std::mutex mutex;
        Box3 box;
        input.stream([&](const TriangleSoup& batch, std::uint64_t) {
            const Box3 of_batch = bounding_box(batch, {.threads = 1});
            const std::lock_guard lock(mutex);
            box.add(of_batch);
        });
        const Plan plan = plan_uniform(box.min.z, box.max.z, {.layer_height = std::atof(argv[2])});
        SectionSum sum(plan, {(box.min.x + box.max.x) / 2, (box.min.y + box.max.y) / 2, 0});
        input.stream([&](const TriangleSoup& batch, std::uint64_t) { sum.add(batch); });
        for (const double area : sum.areas())
            std::printf("%.17g\n", area);
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
