#include "lamella/c/lamella.h"

#include "lamella/contour/layer.hpp"
#include "lamella/contour/measure.hpp"
#include "lamella/core/error.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/core/version.hpp"
#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/pipeline/layer_findings.hpp"
#include "lamella/pipeline/plate.hpp"
#include "lamella/pipeline/slice_file.hpp"
#include "lamella/read/layer_file.hpp"
#include "lamella/read/mesh_file.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"
#include "lamella/slicing/slicer.hpp"
#include "lamella/write/layer_writer.hpp"

#include "core/counted.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <limits>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <utility>
#include <vector>

struct lamella_mesh {
    std::shared_ptr<const lamella::MeshFile> file;
    lamella::Transform placement;
    lamella::Plate plate; ///< the placed file
};

struct lamella_layers {
    lamella::LayerStack layers;
    lamella::PlaneRule rule = lamella::PlaneRule::section_above;
};

struct lamella_slicer {
    lamella::Slicer slicer;
};

namespace lamella {
namespace {

/// The texts of a thread, as errno is the number of its last error.
struct Messages {
    std::string error;
    std::string warnings;
};
thread_local Messages messages; // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

lamella_status status_of(ErrorKind kind) noexcept {
    switch (kind) {
    case ErrorKind::internal:
        return LAMELLA_INTERNAL;
    case ErrorKind::usage:
        return LAMELLA_USAGE;
    case ErrorKind::input:
        return LAMELLA_INPUT;
    case ErrorKind::defect:
        return LAMELLA_DEFECT;
    case ErrorKind::limit:
        return LAMELLA_LIMIT;
    case ErrorKind::output:
        return LAMELLA_OUTPUT;
    case ErrorKind::cancelled:
        return LAMELLA_CANCELLED;
    }
    return LAMELLA_INTERNAL;
}

/// Turns exceptions into a status and a text.
template <class Work>
lamella_status guarded(const Work& work) noexcept {
    try {
        messages.warnings.clear();
        try {
            work();
            return LAMELLA_OK;
        } catch (const Error& error) {
            messages.error = error.what();
            return status_of(error.kind());
        } catch (const std::bad_alloc&) {
            messages.error = "there is not enough memory";
            return LAMELLA_NO_MEMORY;
        } catch (const std::exception& error) {
            messages.error = error.what();
            return LAMELLA_INTERNAL;
        }
    } catch (...) { // there is no memory for the text
        return LAMELLA_NO_MEMORY;
    }
}

template <class T>
T& required(T* pointer, const char* name) {
    if (pointer == nullptr)
        throw Error(ErrorKind::usage, fmt::format("{}: found a null pointer", name));
    return *pointer;
}

/// Runs work whose result is a handle.
template <class Handle, class Work>
lamella_status give(Handle** to, const char* name, const Work& work) noexcept {
    return guarded([&] {
        Handle*& result = required(to, name);
        result = std::make_unique<Handle>(work()).release();
    });
}

Execution execution_of(const lamella_settings* settings) {
    if (settings == nullptr)
        return {};
    Execution execution{.threads = settings->threads};
    if (settings->progress != nullptr)
        execution.progress = [settings](const Progress& progress) {
            if (settings->progress(settings->user, stage_name(progress.stage), progress.done,
                                   progress.total) != 0)
                throw Error(ErrorKind::cancelled, "the progress function asked to stop");
        };
    if (settings->run_tasks != nullptr)
        execution.run_tasks = [settings](unsigned tasks, const std::function<void(unsigned)>& task) {
            settings->run_tasks(
                settings->user, tasks,
                [](void* data, uint32_t number) {
                    (*static_cast<const std::function<void(unsigned)>*>(data))(number);
                },
                const_cast<std::function<void(unsigned)>*>(&task));
        };
    return execution;
}

std::uint64_t memory_of(const lamella_settings* settings) {
    return settings == nullptr ? 0 : settings->max_memory;
}

void warn(const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings)
        messages.warnings += warning + '\n';
}

lamella_mesh placed(std::shared_ptr<const MeshFile> file, const Transform& placement,
                    const Execution& execution = {}) {
    Plate plate = load_plate({.path = file->path, .placement = placement}, *file, execution);
    return {std::move(file), placement, std::move(plate)};
}

lamella_mesh read(MeshFile file, const Execution& execution) {
    warn(file.warnings);
    return placed(std::make_shared<const MeshFile>(std::move(file)), {}, execution);
}

/// Throws Error{usage} if an array of so many items of this size cannot exist.
std::size_t possible(std::size_t count, std::size_t bytes_each, const char* name) {
    if (count > static_cast<std::size_t>(std::numeric_limits<std::ptrdiff_t>::max()) / bytes_each)
        throw Error(ErrorKind::usage, fmt::format("{}: found {}, more than any array has", name, count));
    return count;
}

/// `numbers` are three.
Point3 point_of(const double* numbers, const char* name) {
    static_cast<void>(required(numbers, name));
    return {numbers[0], numbers[1], numbers[2]};
}

void put(const Transform& map, double* rows) {
    for (std::size_t r = 0; r < 3; ++r) {
        rows = std::copy(map.linear[r].begin(), map.linear[r].end(), rows);
        *rows++ = map.offset[r];
    }
}

lamella_layers one_layer(Layer layer) {
    lamella_layers layers;
    layers.layers.push_back(std::move(layer));
    return layers;
}

lamella_layers sliced(const Plate& plate, const Cut& cut, const lamella_settings* settings) {
    const Execution execution = execution_of(settings);
    FileJob job;
    job.layering.cut = cut;
    job.max_memory = memory_of(settings);
    lamella_layers result{slice(plate, plan_of(job, plate, execution), {.execution = execution})};
    warn(layer_findings({&result.layers, 1}, LayerUse::cut, {}, InversionSearch::quick, execution).texts());
    return result;
}

lamella_layers merged(const LayerFile& file, const Execution& execution) {
    warn(file.warnings);
    if (file.parts.size() > 1)
        warn({fmt::format("{}: the contours of {} parts are one layer on each plane", file.path,
                          file.parts.size())});
    std::uint64_t hatches = 0;
    for (const LayerPart& part : file.parts)
        hatches += part.hatch_lines();
    if (hatches > 0)
        warn({fmt::format("{}: {} left out", file.path, counted(hatches, "hatch line"))});
    return {file.merged(execution), file.rule};
}

} // namespace
} // namespace lamella

using namespace lamella;

uint32_t lamella_abi(void) {
    return LAMELLA_ABI;
}

const char* lamella_version(void) {
    return version();
}

const char* lamella_error(void) {
    return messages.error.c_str();
}

const char* lamella_warnings(void) {
    return messages.warnings.c_str();
}

lamella_status lamella_read_mesh(const char* path, const lamella_settings* settings, lamella_mesh** mesh) {
    return give(mesh, "mesh", [&] {
        const Execution execution = execution_of(settings);
        return read(read_mesh(&required(path, "path"), {.max_memory = memory_of(settings)}, execution),
                    execution);
    });
}

lamella_status lamella_read_mesh_bytes(const void* bytes, size_t size, const char* name,
                                       const lamella_settings* settings, lamella_mesh** mesh) {
    return give(mesh, "mesh", [&] {
        const Execution execution = execution_of(settings);
        const std::span<const std::byte> content(&required(static_cast<const std::byte*>(bytes), "bytes"),
                                                 possible(size, 1, "size"));
        return read(
            read_mesh(content, &required(name, "name"), {.max_memory = memory_of(settings)}, execution),
            execution);
    });
}

lamella_status lamella_make_mesh(const double* vertices, size_t vertex_count, const uint32_t* triangles,
                                 size_t triangle_count, lamella_mesh** mesh) {
    return give(mesh, "mesh", [&] {
        IndexedMesh made;
        const double* const numbers = &required(vertices, "vertices");
        made.vertices.resize(possible(vertex_count, sizeof(Point3), "vertex_count"));
        for (size_t i = 0; i < vertex_count; ++i)
            made.vertices[i] = {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
        const std::uint32_t* const indices = &required(triangles, "triangles");
        made.triangles.resize(possible(triangle_count, 3 * sizeof *indices, "triangle_count"));
        for (size_t i = 0; i < triangle_count; ++i)
            made.triangles[i] = {indices[3 * i], indices[3 * i + 1], indices[3 * i + 2]};
        MeshFile file;
        file.path = "part";
        file.stored_triangles = triangle_count;
        file.objects.push_back({"part", Mesh(std::move(made))});
        file.instances.push_back({});
        return placed(std::make_shared<const MeshFile>(std::move(file)), {});
    });
}

lamella_status lamella_transform_mesh(const lamella_mesh* mesh, const double* matrix,
                                      lamella_mesh** transformed) {
    return give(transformed, "transformed", [&] {
        const lamella_mesh& from = required(mesh, "mesh");
        const double* rows = &required(matrix, "matrix");
        Transform map;
        for (std::size_t r = 0; r < 3; ++r, rows += 4) {
            std::copy(rows, rows + 3, map.linear[r].begin());
            map.offset[r] = rows[3];
        }
        return placed(from.file, compose(map, from.placement));
    });
}

size_t lamella_triangle_count(const lamella_mesh* mesh) {
    size_t count = 0;
    if (mesh != nullptr)
        for (const PlatePart& part : mesh->plate.parts)
            count += mesh->plate.shapes[part.shape].mesh.size();
    return count;
}

lamella_status lamella_mesh_box(const lamella_mesh* mesh, double* box) {
    return guarded([&] {
        const Box3& of_mesh = required(mesh, "mesh").plate.box;
        double* to = &required(box, "box");
        for (const Point3& corner : {of_mesh.min, of_mesh.max})
            for (const double number : {corner.x, corner.y, corner.z})
                *to++ = number;
    });
}

void lamella_free_mesh(lamella_mesh* mesh) {
    delete mesh;
}

lamella_status lamella_slice(const lamella_mesh* mesh, double layer_height, const lamella_settings* settings,
                             lamella_layers** layers) {
    return give(layers, "layers", [&] {
        return sliced(required(mesh, "mesh").plate, UniformLayers{.layer_height = layer_height}, settings);
    });
}

lamella_status lamella_slice_at(const lamella_mesh* mesh, const double* heights, size_t count,
                                const lamella_settings* settings, lamella_layers** layers) {
    return give(layers, "layers", [&] {
        const double* const z = &required(heights, "heights");
        return sliced(required(mesh, "mesh").plate,
                      ListedPlanes{.z = {z, z + possible(count, sizeof *z, "count")}}, settings);
    });
}

lamella_status lamella_prepare(const lamella_mesh* mesh, const lamella_settings* settings,
                               lamella_slicer** slicer) {
    return give(slicer, "slicer", [&] {
        const Plate& plate = required(mesh, "mesh").plate;
        if (!plate.negatives.empty())
            throw Error(ErrorKind::usage, "mesh: its negative volumes cannot be subtracted from single "
                                          "sections; lamella_slice_at subtracts them");
        const Execution execution = execution_of(settings);
        return lamella_slicer{Slicer(joined(plate, execution), PlaneRule::section_above, execution)};
    });
}

lamella_status lamella_section(const lamella_slicer* slicer, double z, lamella_layers** layers) {
    return give(layers, "layers", [&] { return one_layer(required(slicer, "slicer").slicer.section(z)); });
}

lamella_status lamella_section_of_plane(const lamella_slicer* slicer, const double* origin,
                                        const double* normal, double* to_mesh, lamella_layers** layers) {
    Transform map;
    const lamella_status status = give(layers, "layers", [&] {
        PlaneSection section =
            required(slicer, "slicer").slicer.section(point_of(origin, "origin"), point_of(normal, "normal"));
        map = section.to_mesh;
        return one_layer(std::move(section.layer));
    });
    if (status == LAMELLA_OK && to_mesh != nullptr)
        put(map, to_mesh);
    return status;
}

void lamella_free_slicer(lamella_slicer* slicer) {
    delete slicer;
}

lamella_status lamella_read_layers(const char* path, const lamella_settings* settings,
                                   lamella_layers** layers) {
    return give(layers, "layers", [&] {
        const Execution execution = execution_of(settings);
        return merged(read_layers(&required(path, "path"), {.max_memory = memory_of(settings)}, execution),
                      execution);
    });
}

lamella_status lamella_write_layers(const lamella_layers* layers, const char* path, const char* format,
                                    const lamella_settings* settings) {
    return guarded([&] {
        const auto& [stack, rule] = required(layers, "layers");
        const std::string to = &required(path, "path");
        if (stack.empty())
            throw Error(ErrorKind::usage, "layers: there are none to write");
        const Execution execution = execution_of(settings);
        const Box3 box = part_box(stack, {}, execution);
        const LayerFileInfo info{.box = box.empty() ? Box3{Point3{}, Point3{}} : box,
                                 .layers = stack.size(),
                                 .bottom = stack.front().bottom,
                                 .parts = {{.box = box}},
                                 .rule = rule};
        warn(write_layers(to, layer_format(format == nullptr ? "" : format, to),
                          std::span<const Layer>(stack), info, {}, execution));
    });
}

size_t lamella_layer_count(const lamella_layers* layers) {
    return layers == nullptr ? 0 : layers->layers.size();
}

lamella_status lamella_get_layer(const lamella_layers* layers, size_t number, lamella_layer* layer) {
    return guarded([&] {
        const LayerStack& stack = required(layers, "layers").layers;
        if (number >= stack.size())
            throw Error(ErrorKind::usage,
                        fmt::format("number: found {}, and there are {} layers", number, stack.size()));
        const Layer& from = stack[number];
        static_assert(sizeof(Point2) == 2 * sizeof(double));
        required(layer, "layer") = {.index = from.index,
                                    .z = from.z,
                                    .bottom = from.bottom,
                                    .top = from.top,
                                    .points = reinterpret_cast<const double*>(from.points.data()),
                                    .point_count = from.points.size(),
                                    .offsets = from.offsets.data(),
                                    .contour_count = from.contours(),
                                    .rings = from.rings,
                                    .area_mm2 = measure(from).area_mm2};
    });
}

void lamella_free_layers(lamella_layers* layers) {
    delete layers;
}
