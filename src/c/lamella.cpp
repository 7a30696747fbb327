#include "lamella/c/lamella.h"

#include "lamella/contour/close_gaps.hpp"
#include "lamella/contour/layer.hpp"
#include "lamella/contour/measure.hpp"
#include "lamella/core/error.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/core/version.hpp"
#include "lamella/inputs/read_file.hpp"
#include "lamella/jobs/layer_findings.hpp"
#include "lamella/jobs/plate.hpp"
#include "lamella/jobs/repair_policies.hpp"
#include "lamella/jobs/slice_file.hpp"
#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/polygon/boolean.hpp"
#include "lamella/polygon/layer_steps.hpp"
#include "lamella/polygon/nesting.hpp"
#include "lamella/slices/layer_writer.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"
#include "lamella/slicing/slicer.hpp"

#include "core/counted.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <functional>
#include <initializer_list>
#include <limits>
#include <memory>
#include <new>
#include <optional>
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

struct lamella_bytes {
    std::string content;
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

/// Larger structs are not read: a size like this was not set.
constexpr std::size_t largest_struct = 4096;

/// Throws for a size that a struct of no version of the header has.
template <class T>
void check_size(const T& given, const char* name) {
    if (given.size < sizeof(T) || given.size > largest_struct)
        throw Error(ErrorKind::usage, fmt::format("{}: its size is {}, but has to be that of the struct, {}",
                                                  name, given.size, sizeof(T)));
}

/// Returns a copy of a struct of the caller, whose header may be newer than this library; zeros for null.
template <class T>
T copy_of(const T* given, const char* name) {
    T copy{};
    if (given == nullptr)
        return copy;
    check_size(*given, name);
    const auto* const bytes = reinterpret_cast<const unsigned char*>(given);
    if (std::any_of(bytes + sizeof(T), bytes + given->size, [](unsigned char byte) { return byte != 0; }))
        throw Error(ErrorKind::usage,
                    fmt::format("{}: has fields that Lamella {} does not have; update it, or set them to 0",
                                name, version()));
    std::memcpy(&copy, given, sizeof(T));
    return copy;
}

/// Fills a struct of the caller. Fields that this library does not have stay as they are.
template <class T>
void set_fields(T* into, const char* name, T value) {
    check_size(required(into, name), name);
    value.size = into->size;
    std::memcpy(into, &value, sizeof(T));
}

/// Returns the value of an enumeration of the interface if there is one of this number.
template <class Value, class Enum>
Value chosen(Enum number, std::initializer_list<Value> values, const char* name) {
    if (static_cast<std::size_t>(number) >= values.size())
        throw Error(ErrorKind::usage, fmt::format("{}: found {}, expected a value from 0 to {}", name,
                                                  static_cast<long long>(number), values.size() - 1));
    return values.begin()[static_cast<std::size_t>(number)];
}

/// Runs work whose result is a handle.
template <class Handle, class Work>
lamella_status give(Handle** to, const char* name, const Work& work) noexcept {
    return guarded([&] {
        Handle*& result = required(to, name);
        result = std::make_unique<Handle>(work()).release();
    });
}

Execution execution_of(const lamella_settings* given) {
    const lamella_settings settings = copy_of(given, "settings");
    Execution execution{.threads = settings.threads};
    if (settings.progress != nullptr)
        execution.progress = [settings](const Progress& progress) {
            if (settings.progress(settings.user, stage_name(progress.stage), progress.done, progress.total) !=
                0)
                throw Error(ErrorKind::cancelled, "the progress function asked to stop");
        };
    if (settings.run_tasks != nullptr)
        execution.run_tasks = [settings](unsigned tasks, const std::function<void(unsigned)>& task) {
            settings.run_tasks(
                settings.user, tasks,
                [](void* data, uint32_t number) {
                    (*static_cast<const std::function<void(unsigned)>*>(data))(number);
                },
                const_cast<std::function<void(unsigned)>*>(&task));
        };
    return execution;
}

std::uint64_t memory_of(const lamella_settings* settings) {
    return copy_of(settings, "settings").max_memory;
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

/// Throws Error{usage} if no array can have this number of items of this size.
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

lamella_layers sliced(const Plate& plate, Layering layering, const lamella_settings* settings) {
    const Execution execution = execution_of(settings);
    FileJob job;
    job.layering = std::move(layering);
    job.max_memory = memory_of(settings);
    const Plan plan = plan_of(job, plate, execution);
    lamella_layers result{slice(plate, plan, {.execution = execution}), plan.rule};
    warn(layer_findings(source_of({result.layers}, {}, execution), LayerUse::cut, InversionSearch::quick,
                        execution)
             .texts());
    return result;
}

lamella_layers merged(const LayerFile& file, const Execution& execution) {
    warn(file.warnings);
    if (file.parts.size() > 1)
        warn({fmt::format("{}: the contours of {} parts are one layer on each plane", file.path,
                          file.parts.size())});
    if (const std::uint64_t hatches = file.hatch_lines(); hatches > 0)
        warn({fmt::format("{}: {} left out", file.path, counted(hatches, "hatch line"))});
    return {file.merged(execution), file.rule};
}

Layering layering_of(const lamella_plan& plan) {
    Layering layering{.at = chosen(plan.cut, {SliceAt::middle, SliceAt::bottom, SliceAt::top}, "plan: cut"),
                      .snap_mm = plan.snap};
    if (plan.max_height != 0 || plan.min_height != 0 || plan.cusp != 0) {
        if (plan.layer_height != 0 || plan.first_layer_height != 0)
            throw Error(ErrorKind::usage, "plan: layer_height and max_height contradict each other");
        AdaptiveLayers layers{.min_height = plan.min_height, .max_height = plan.max_height};
        if (plan.cusp != 0)
            layers.cusp_mm = plan.cusp;
        layering.cut = layers;
        return layering;
    }
    UniformLayers layers;
    if (plan.layer_height != 0)
        layers.layer_height = plan.layer_height;
    if (plan.first_layer_height != 0)
        layers.first_layer_height = plan.first_layer_height;
    layering.cut = layers;
    return layering;
}

RepairPolicies policies_of(const lamella_mending& mending) {
    RepairPolicies policies;
    policies.drop_duplicates = mending.drop_duplicates != 0;
    policies.orient = mending.orient != 0;
    if (mending.weld_tolerance != 0)
        policies.weld_tolerance_mm = mending.weld_tolerance;
    return policies;
}

lamella_mended sum_of(const std::vector<MeshRepairs>& repairs) {
    lamella_mended sum{};
    for (const MeshRepairs& found : repairs) {
        if (found.welded) {
            sum.joined_vertices += found.welded->joined_vertices;
            sum.collapsed_triangles += found.welded->collapsed_triangles;
        }
        if (found.dropped) {
            sum.repeated_triangles += found.dropped->repeated_triangles;
            sum.opposite_triangles += found.dropped->opposite_triangles;
        }
        if (found.oriented)
            sum.flipped_triangles += found.oriented->flipped_triangles;
    }
    return sum;
}

/// Adds a contour, without points equal to the one before them, unless too few points remain.
void add_contour(LayerBuilder& builder, std::vector<Point2>& contour, bool closed) {
    contour.erase(std::unique(contour.begin(), contour.end()), contour.end());
    while (closed && contour.size() > 1 && contour.back() == contour.front())
        contour.pop_back();
    if (contour.size() >= (closed ? 3U : 2U))
        builder.add_contour(contour, closed);
}

/// Copies a layer of the caller into normal form. Throws Error{usage} for arrays that describe no layer.
Layer layer_of(const lamella_layer& from) {
    const bool heights =
        std::isfinite(from.bottom) && std::isfinite(from.top) && from.bottom <= from.z && from.z <= from.top;
    if (!heights)
        throw Error(ErrorKind::usage, "layer: z has to lie between bottom and top, which are finite");
    if (from.contour_count > 0 && (from.points == nullptr || from.offsets == nullptr))
        throw Error(ErrorKind::usage, "layer: found a null pointer instead of its points or offsets");
    if (from.rings > from.contour_count)
        throw Error(ErrorKind::usage, fmt::format("layer: found {} rings among {}", from.rings,
                                                  counted(from.contour_count, "contour")));
    LayerBuilder builder;
    std::vector<Point2> contour;
    for (std::size_t i = 0; i < from.contour_count; ++i) {
        const std::uint64_t begin = from.offsets[i];
        const std::uint64_t end = from.offsets[i + 1];
        if (begin > end || end > from.point_count)
            throw Error(
                ErrorKind::usage,
                fmt::format("layer: offsets[{}] is {}, which is not from {} to the number of points, {}",
                            i + 1, end, begin, from.point_count));
        contour.clear();
        for (std::uint64_t k = begin; k < end; ++k)
            contour.push_back({from.points[2 * k] + 0.0, from.points[2 * k + 1] + 0.0}); // -0 becomes 0
        add_contour(builder, contour, i < from.rings);
    }
    Layer layer = builder.finish(from.index, from.z, from.bottom, from.top);
    check(layer);
    return layer;
}

/// The contents of a slice file, and what the writer needs to know before the layers.
struct Writing {
    const LayerFormat& format;
    LayerFileInfo info;
};

Writing writing_of(const lamella_layers& layers, const char* format, const std::string& path,
                   const Execution& execution) {
    const LayerStack& stack = layers.layers;
    if (stack.empty())
        throw Error(ErrorKind::usage, "layers: there are none to write");
    const Box3 box = part_box(stack, {}, execution);
    return {layer_format(format == nullptr ? "" : format, path),
            {.box = box.empty() ? Box3{Point3{}, Point3{}} : box,
             .layers = stack.size(),
             .bottom = stack.front().bottom,
             .parts = {{.box = box}},
             .rule = layers.rule}};
}

std::vector<Plane> planes_of(const lamella_layers& layers) {
    return {layers.layers.begin(), layers.layers.end()};
}

/// Returns the layers after a change of each of them.
template <class Change>
lamella_layers changed(const lamella_layers& layers, const Execution& execution, const Change& change) {
    lamella_layers result{{}, layers.rule};
    const std::size_t count = layers.layers.size();
    for (std::size_t i = 0; i < count; ++i) {
        result.layers.push_back(change(i, layers.layers[i]));
        if (execution.progress)
            execution.progress({Stage::polygon, i + 1, count});
    }
    return result;
}

/// Returns the layer of this number. Throws Error{usage} if there is none.
const Layer& at(const lamella_layers* layers, std::size_t number) {
    const LayerStack& stack = required(layers, "layers").layers;
    if (number >= stack.size())
        throw Error(ErrorKind::usage,
                    fmt::format("number: found {}, and there are {} layers", number, stack.size()));
    return stack[number];
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

lamella_status lamella_mend(const lamella_mesh* mesh, const lamella_mending* mending,
                            const lamella_settings* settings, lamella_mended* counts, lamella_mesh** mended) {
    return give(mended, "mended", [&] {
        const lamella_mesh& from = required(mesh, "mesh");
        const RepairPolicies policies = policies_of(copy_of(&required(mending, "mending"), "mending"));
        if (!policies.change_the_mesh())
            throw Error(ErrorKind::usage, "mending: asks for nothing; set at least one of its fields");
        if (counts != nullptr)
            check_size(*counts, "counts");
        const Execution execution = execution_of(settings);
        RepairedFile whole = repaired(*from.file, {}, from.placement, policies, execution);
        lamella_mesh result = placed(std::make_shared<const MeshFile>(std::move(whole.file)), {}, execution);
        if (counts != nullptr)
            set_fields(counts, "counts", sum_of(whole.repairs));
        return result;
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
        return sliced(required(mesh, "mesh").plate, {.cut = UniformLayers{.layer_height = layer_height}},
                      settings);
    });
}

lamella_status lamella_slice_at(const lamella_mesh* mesh, const double* heights, size_t count,
                                const lamella_settings* settings, lamella_layers** layers) {
    return give(layers, "layers", [&] {
        const double* const z = &required(heights, "heights");
        return sliced(required(mesh, "mesh").plate,
                      {.cut = ListedPlanes{.z = {z, z + possible(count, sizeof *z, "count")}}}, settings);
    });
}

lamella_status lamella_slice_by_plan(const lamella_mesh* mesh, const lamella_plan* plan,
                                     const lamella_settings* settings, lamella_layers** layers) {
    return give(layers, "layers", [&] {
        return sliced(required(mesh, "mesh").plate, layering_of(copy_of(&required(plan, "plan"), "plan")),
                      settings);
    });
}

lamella_status lamella_prepare(const lamella_mesh* mesh, lamella_rule rule, const lamella_settings* settings,
                               lamella_slicer** slicer) {
    return give(slicer, "slicer", [&] {
        const PlaneRule of_planes =
            chosen(rule, {PlaneRule::section_above, PlaneRule::section_below}, "rule");
        const Plate& plate = required(mesh, "mesh").plate;
        if (!plate.negatives.empty())
            throw Error(ErrorKind::usage, "mesh: its negative volumes cannot be subtracted from single "
                                          "sections; lamella_slice_at subtracts them");
        const Execution execution = execution_of(settings);
        return lamella_slicer{Slicer(joined(plate, execution), of_planes, execution)};
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

lamella_status lamella_read_layers_bytes(const void* bytes, size_t size, const char* name,
                                         const lamella_settings* settings, lamella_layers** layers) {
    return give(layers, "layers", [&] {
        const Execution execution = execution_of(settings);
        const std::span<const std::byte> content(&required(static_cast<const std::byte*>(bytes), "bytes"),
                                                 size);
        return merged(
            read_layers(content, &required(name, "name"), {.max_memory = memory_of(settings)}, execution),
            execution);
    });
}

lamella_status lamella_make_layer(const lamella_layer* layer, lamella_layers** layers) {
    return give(layers, "layers",
                [&] { return one_layer(layer_of(copy_of(&required(layer, "layer"), "layer"))); });
}

lamella_status lamella_write_layers(const lamella_layers* layers, const char* path, const char* format,
                                    const lamella_settings* settings) {
    return guarded([&] {
        const lamella_layers& from = required(layers, "layers");
        const std::string to = &required(path, "path");
        const Execution execution = execution_of(settings);
        const Writing writing = writing_of(from, format, to, execution);
        warn(write_layers(to, writing.format, planes_of(from), writing.info, {}, execution));
    });
}

lamella_status lamella_write_layers_bytes(const lamella_layers* layers, const char* format,
                                          const lamella_settings* settings, lamella_bytes** bytes) {
    return give(bytes, "bytes", [&] {
        const lamella_layers& from = required(layers, "layers");
        const Execution execution = execution_of(settings);
        Writing writing = writing_of(from, &required(format, "format"), "layers", execution);
        lamella_bytes result;
        writing.info.memory = &result.content;
        warn(write_layers("layers", writing.format, planes_of(from), writing.info, {}, execution));
        return result;
    });
}

const void* lamella_bytes_data(const lamella_bytes* bytes) {
    return bytes == nullptr ? nullptr : bytes->content.data();
}

size_t lamella_bytes_size(const lamella_bytes* bytes) {
    return bytes == nullptr ? 0 : bytes->content.size();
}

void lamella_free_bytes(lamella_bytes* bytes) {
    delete bytes;
}

size_t lamella_layer_count(const lamella_layers* layers) {
    return layers == nullptr ? 0 : layers->layers.size();
}

lamella_status lamella_get_layer(const lamella_layers* layers, size_t number, lamella_layer* layer) {
    return guarded([&] {
        const Layer& from = at(layers, number);
        static_assert(sizeof(Point2) == 2 * sizeof(double));
        set_fields(layer, "layer",
                   {.size = sizeof(lamella_layer),
                    .index = from.index,
                    .z = from.z,
                    .bottom = from.bottom,
                    .top = from.top,
                    .points = reinterpret_cast<const double*>(from.points.data()),
                    .point_count = from.points.size(),
                    .offsets = from.offsets.data(),
                    .contour_count = from.contours(),
                    .rings = from.rings,
                    .area_mm2 = measure(from).area_mm2});
    });
}

lamella_status lamella_ring_parents(const lamella_layers* layers, size_t number, int64_t* parents) {
    return guarded([&] {
        const Layer& layer = at(layers, number);
        int64_t* const to = &required(parents, "parents");
        const Nesting found = nesting(layer);
        std::fill(to, to + layer.contours(), int64_t{-1});
        for (std::size_t i = 0; i < found.rings(); ++i)
            if (found.parent[i] != Nesting::none)
                to[i] = found.parent[i];
    });
}

lamella_status lamella_close_gaps(const lamella_layers* layers, double distance,
                                  const lamella_settings* settings, uint64_t* closed,
                                  lamella_layers** result) {
    return give(result, "result", [&] {
        std::uint64_t joins = 0;
        const Execution execution = execution_of(settings);
        const LayerLimits limits = layer_limits(execution);
        lamella_layers made =
            changed(required(layers, "layers"), execution, [&](std::size_t, const Layer& layer) {
                ClosedGaps found = close_gaps(layer, distance, limits);
                joins += found.joins.size();
                return std::move(found.layer);
            });
        if (closed != nullptr)
            *closed = joins;
        return made;
    });
}

lamella_status lamella_offset(const lamella_layers* layers, double distance, const lamella_corners* corners,
                              const lamella_settings* settings, lamella_layers** result) {
    return give(result, "result", [&] {
        const lamella_layers& from = required(layers, "layers");
        const lamella_corners given = copy_of(corners, "corners");
        OffsetCorners joins{.shape = chosen(given.join,
                                            {OffsetCorner::mitre, OffsetCorner::bevel, OffsetCorner::round},
                                            "corners: join")};
        if (given.mitre_limit != 0)
            joins.mitre_limit = given.mitre_limit;
        if (given.arc_tolerance != 0)
            joins.arc_tolerance_mm = given.arc_tolerance;
        const LayerSteps steps{.offset_mm = distance, .offset_corners = joins};
        check_steps(steps);
        ChangedStacks made = take_steps(steps, {from.layers}, {.execution = execution_of(settings)});
        return lamella_layers{std::move(made.parts.front()), from.rule};
    });
}

lamella_status lamella_combine(const lamella_layers* first, const lamella_layers* second,
                               lamella_operation operation, const lamella_settings* settings,
                               lamella_layers** result) {
    return give(result, "result", [&] {
        const lamella_layers& one = required(first, "first");
        const LayerStack& others = required(second, "second").layers;
        if (one.layers.size() != others.size())
            throw Error(ErrorKind::usage, fmt::format("second: found {}, and first has {}",
                                                      counted(others.size(), "layer"), one.layers.size()));
        const BooleanOperation how = chosen(operation,
                                            {BooleanOperation::unite, BooleanOperation::intersect,
                                             BooleanOperation::subtract, BooleanOperation::exclude},
                                            "operation");
        const Execution execution = execution_of(settings);
        const LayerLimits limits = layer_limits(execution);
        return changed(one, execution, [&](std::size_t i, const Layer& layer) {
            return combine(layer, others[i], how, limits);
        });
    });
}

void lamella_free_layers(lamella_layers* layers) {
    delete layers;
}
