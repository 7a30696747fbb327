#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"
#include "lamella/inputs/read_file.hpp"
#include "lamella/jobs/layer_findings.hpp"
#include "lamella/jobs/print_check.hpp"
#include "lamella/jobs/verify.hpp"
#include "lamella/meshes/mesh_writer.hpp"
#include "lamella/polygon/compare.hpp"
#include "lamella/polygon/layer_steps.hpp"
#include "lamella/scan/strategy.hpp"
#include "lamella/slices/layer_writer.hpp"
#include "lamella/slices/resin_fields.hpp"

#include "bindings.hpp"
#include "gil_release.hpp"
#include "input.hpp"
#include "placing.hpp"
#include "python_tables.hpp"
#include "run.hpp"
#include "shared_layer.hpp"
#include "source_mesh.hpp"
#include "source_plate.hpp"
#include "texts.hpp"
#include "viewer/viewer_page.hpp"

#include <pybind11/stl.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

namespace py = pybind11;

namespace lamella::python {
namespace {

bool holds_scan_vectors(const LayerFile& file) {
    return std::any_of(file.parts.begin(), file.parts.end(),
                       [](const PartInfo& part) { return part.exposure.has_value(); });
}

bool holds_scan_vectors(const Stack& stack) {
    return stack.exposure || std::any_of(stack.parts.begin(), stack.parts.end(),
                                         [](const StackPointer& part) { return holds_scan_vectors(*part); });
}

StackPointer stack_of(const LayerFile& file, std::string label, LayerStack layers,
                      std::vector<PointArray> hatches, std::vector<StackPointer> parts = {}) {
    auto stack = std::make_shared<Stack>();
    stack->layers = shared(std::move(layers), file.rule, std::move(hatches), parts);
    stack->parts = std::move(parts);
    stack->label = std::move(label);
    stack->box = box_of(stack->layers);
    stack->planned = stack->layers.empty() ? 0 : stack->layers.back()->get().index + 1;
    stack->path = file.path;
    stack->format = file.format;
    stack->rounding = file.rounding;
    stack->rule = file.rule;
    return stack;
}

/// Returns the hatch lines of all parts on each plane.
std::vector<PointArray> merged_hatches(const std::vector<LayerPart>& parts) {
    std::vector<PointArray> merged(parts.front().layers.size());
    for (std::size_t plane = 0; plane < merged.size(); ++plane) {
        std::vector<Point2> ends;
        for (const LayerPart& part : parts) {
            const std::span<const Point2> hatches = part.hatches_of(plane);
            ends.insert(ends.end(), hatches.begin(), hatches.end());
        }
        if (!ends.empty())
            merged[plane] = PointArray(std::move(ends));
    }
    return merged;
}

/// Returns the stack of the file, with a stack of each part if there are several.
StackPointer stack_of(const LayerFile& file, const Execution& execution) {
    std::vector<LayerPart> read = file.in_memory(execution);
    const bool several = read.size() > 1;
    LayerStack merged = several ? file.merged(execution) : LayerStack();
    std::vector<PointArray> hatches = several ? merged_hatches(read) : std::vector<PointArray>();
    std::vector<StackPointer> parts;
    for (LayerPart& part : read) {
        const StackPointer& stack =
            parts.emplace_back(stack_of(file, part.label, std::move(part.layers), std::move(part.hatches)));
        stack->exposure = std::move(part.exposure);
        stack->support = part.support;
    }
    if (!several)
        return parts.front();
    return stack_of(file, {}, std::move(merged), std::move(hatches), std::move(parts));
}

/// Returns the layers of the file, and its warnings.
std::pair<StackPointer, std::vector<py::str>> read_stack(const py::object& source, std::uint64_t max_memory,
                                                         unsigned threads, const py::object& progress) {
    const Input input(source);
    std::vector<std::string> warnings;
    const StackPointer read = result_of(threads, progress, [&](const Execution& execution) {
        LayerFile file = input.read_by([&](const auto&... from) {
            return read_layers(from..., LayerReadOptions{.max_memory = max_memory}, execution);
        });
        warnings = std::move(file.warnings);
        return stack_of(file, execution);
    });
    return {read, message_texts(warnings)};
}

/// Returns the mesh or the layers of the file, and its warnings.
std::pair<std::variant<MeshPointer, StackPointer>, std::vector<py::str>>
read_either(const py::object& source, std::optional<double> unit_mm, bool strict, const std::string& include,
            std::uint64_t max_triangles, std::uint64_t max_memory, unsigned threads,
            const py::object& progress) {
    const Input input(source);
    const MeshReadOptions options{strict, roles_named(include), max_triangles, max_memory};
    std::vector<std::string> warnings;
    using Either = std::variant<MeshPointer, StackPointer>;
    const auto read = result_of(threads, progress, [&](const Execution& execution) -> Either {
        auto file = input.read_by([&](const auto&... from) { return read_any(from..., options, execution); });
        if (auto* const mesh = std::get_if<MeshFile>(&file)) {
            input.label(*mesh);
            MeshPointer made = source_mesh(std::move(*mesh), unit_mm, execution);
            warnings = made->origin().warnings;
            return made;
        }
        auto& layers = std::get<LayerFile>(file);
        warnings = std::move(layers.warnings);
        return stack_of(layers, execution);
    });
    return {read, message_texts(warnings)};
}

/// A slice file under construction. If it is closed or destroyed before `finish`, no file is left behind.
class StackWriter {
  public:
    StackWriter(const std::string& path, const std::string& format, LayerFileInfo info,
                const LayerWriteOptions& options, bool in_memory) {
        if (in_memory)
            info.memory = &memory_;
        writer_ = open_layer_writer(path, layer_format(format, path), info, options);
    }

    /// Writes the layers of each part, plane by plane.
    void write(const std::vector<std::vector<LayerPointer>>& planes, unsigned threads) {
        std::vector<Plane> kept(planes.size());
        for (std::size_t i = 0; i < planes.size(); ++i)
            for (const LayerPointer& part : planes[i])
                kept[i].append(part->plane());
        run(threads, py::none(),
            [&](const Execution& execution) { write_planes(writer(), kept, execution); });
    }

    std::vector<py::str> finish() {
        {
            const GilRelease released;
            writer().finish();
        }
        return message_texts(writer().warnings());
    }

    /// Returns the bytes of a finished file in memory.
    [[nodiscard]] py::bytes content() const { return memory_; }

    void close() {
        const GilRelease released;
        writer_.reset();
    }

  private:
    LayerWriter& writer() {
        if (!writer_)
            throw Error(ErrorKind::usage, "the file is closed");
        return *writer_;
    }

    std::string memory_;
    std::unique_ptr<LayerWriter> writer_;
};

/// Returns the value of an option by its keyword, if it is given.
template <class T>
std::optional<T> option(const py::dict& given, const char* keyword) {
    return given.contains(keyword) ? std::optional(given[keyword].cast<T>()) : std::nullopt;
}

template <class T>
std::optional<AlongXY<T>> along_xy(const py::dict& given, const char* keyword) {
    const auto pair = option<std::pair<T, T>>(given, keyword);
    return pair ? std::optional(AlongXY<T>{pair->first, pair->second}) : std::nullopt;
}

LayerWriteOptions write_options(const py::dict& given) {
    LayerWriteOptions options;
    options.strict = option<bool>(given, "strict").value_or(options.strict);
    options.units_mm = option<double>(given, "units_mm").value_or(options.units_mm);
    options.short_form = option<bool>(given, "short_form").value_or(options.short_form);
    ImageOptions& image = options.image;
    image.pixel_mm = along_xy<double>(given, "pixel_mm");
    image.pixels = along_xy<std::uint32_t>(given, "pixels");
    image.display_mm = along_xy<double>(given, "display_mm");
    if (const auto printer = option<std::string>(given, "printer"))
        options.printer = &find_resin_printer(*printer);
    if (const auto orientation = option<std::string>(given, "orientation"))
        image.portrait = *orientation == "portrait";
    if (const auto mirror = option<std::string>(given, "mirror")) {
        image.mirror_x = mirror->starts_with('x');
        image.mirror_y = mirror->ends_with('y');
    }
    image.raster.antialias = option<unsigned>(given, "antialias").value_or(image.raster.antialias);
    image.raster.gamma = option<double>(given, "gamma").value_or(image.raster.gamma);
    if (const auto curve = option<std::vector<std::pair<double, double>>>(given, "grey_curve")) {
        std::vector<GreyPoint> points;
        for (const auto& [covered, value] : *curve)
            points.push_back({.covered = covered, .value = value});
        image.raster.grey_values = grey_curve(points);
    }
    if (const auto colours = option<std::vector<std::array<std::uint8_t, 3>>>(given, "part_colours")) {
        image.colour_parts = true;
        for (const auto& [red, green, blue] : *colours)
            image.part_colours.push_back({.red = red, .green = green, .blue = blue});
    }
    ResinSettings& resin = options.resin;
    resin = option<ResinSettings>(given, "resin").value_or(resin);
    if (const auto exposure_s = option<double>(given, "exposure_s"))
        resin.exposure_s = exposure_s;
    if (const auto first_exposure_s = option<double>(given, "first_exposure_s"))
        resin.bottom_exposure_s = first_exposure_s;
    if (const auto fade_layers = option<std::uint32_t>(given, "fade_layers"))
        resin.transition_layers = fade_layers;
    options.page.viewer = viewer_page();
    options.page.no_viewer = no_viewer();
    return options;
}

/// Returns the settings of a dict. `source` is the name of the argument or of the file.
ResinSettings resin_settings_of_tables(const std::string& source, const py::object& tables) {
    const ResinSettings settings = resin_settings_of(PythonTables(source, tables));
    try {
        check_resin_settings(settings);
    } catch (const Error& error) {
        throw Error(error.kind(), source + ": " + error.what());
    }
    return settings;
}

/// Returns the formats that take an option of LayerWriteOptions, by its name in LayerFormat.
std::vector<std::string> formats_with(const std::string& name) {
    const auto takes = name == "units"          ? &LayerFormat::units
                       : name == "short_form"   ? &LayerFormat::short_form
                       : name == "part_colours" ? &LayerFormat::part_colours
                       : name == "exposure"     ? &LayerFormat::exposure
                                                : &LayerFormat::image;
    std::vector<std::string> found;
    for (const LayerFormat& format : layer_formats())
        if (format.*takes)
            found.emplace_back(format.name);
    return found;
}

/// Label and bounds of each part, the exposure of its vectors if it has any, and whether it is a support.
using PartHeads = std::vector<std::tuple<std::string, Bounds, std::optional<Exposure>, bool>>;

std::unique_ptr<StackWriter> open_writer(const std::string& path, const std::string& format,
                                         const PartHeads& parts, std::uint64_t layers, double bottom,
                                         const std::string& rule, const py::dict& options, bool in_memory) {
    LayerFileInfo info{.box = {}, .layers = layers, .bottom = bottom, .parts = {}, .rule = rule_named(rule)};
    for (const auto& [label, bounds, exposure, support] : parts) {
        info.parts.push_back({label, box_of(bounds), exposure, support});
        info.box.add(info.parts.back().box);
    }
    if (info.box.empty())
        info.box.add(Point3{0, 0, bottom});
    LayerWriteOptions writing = write_options(options);
    writing.page.title = in_memory ? "layers" : std::filesystem::path(path).filename().string();
    if (layer_format(format, path).exposure)
        writing.resin.created_s = source_date();
    return std::make_unique<StackWriter>(path, format, std::move(info), writing, in_memory);
}

/// Writes a mesh to the path or, unless it is null, to `memory`. Returns the warnings. Must be called without
/// the interpreter lock.
std::vector<std::string> write_mesh_file(const std::string& path, const std::string& format,
                                         const SourceMesh& mesh, const std::string& name, bool strict,
                                         std::string* memory) {
    std::vector<std::string> warnings;
    if (mesh.source().has_negatives()) {
        warnings.emplace_back("its negative volumes are not subtracted: only layers are without them");
        if (strict)
            throw Error(ErrorKind::defect, path + ": " + warnings.front());
    }
    if (format == "ply")
        write_ply(path, mesh.welded({}), memory);
    else if (format == "obj")
        write_obj(path, mesh.welded({}), name, memory);
    else
        for (std::string& warning : write_stl(path, mesh.mesh(), strict, memory))
            warnings.push_back(std::move(warning));
    return warnings;
}

/// Returns the stack after these layer steps of each of its parts, and a line for each finding.
std::pair<StackPointer, std::vector<std::string>> after_steps(const Stack& stack, const std::string& fill,
                                                              const InsetAndHeight& bottom_offset,
                                                              unsigned threads, const py::object& progress) {
    const double plate_mm = stack.layers.empty() ? 0 : stack.layers.front()->get().bottom;
    const LayerSteps steps{.fill = fill_rule(fill), .bottom = bottom_inset(bottom_offset, plate_mm)};
    return result_of(threads, progress, [&](const Execution& execution) {
        ChangedStacks changed = take_steps(steps, plain_parts(stack), {.execution = execution});
        std::uint64_t lost = 0;
        std::uint64_t contours = 0;
        std::vector<StackPointer> parts;
        for (std::size_t i = 0; i < changed.parts.size(); ++i) {
            const Stack& before = stack.parts.empty() ? stack : *stack.parts[i];
            Stack& part = *parts.emplace_back(std::make_shared<Stack>(before));
            std::vector<PointArray> hatches;
            for (std::size_t k = 0; k < part.layers.size(); ++k) {
                const SharedLayer& layer = *before.layers[k];
                const bool kept = same_contours(layer.get(), changed.parts[i][k]);
                hatches.push_back(kept ? layer.hatches() : PointArray());
                lost += kept ? 0 : layer.hatches().size() / 2;
                contours += changed.parts[i][k].contours();
            }
            part.layers = shared(std::move(changed.parts[i]), part.rule, std::move(hatches));
            part.box = box_of(part.layers);
        }
        Findings found;
        if (lost > 0)
            found.add({.kind = FindingKind::outdated_hatch_lines, .count = lost});
        add_nothing_left(found,
                         std::accumulate(changed.planes.begin(), changed.planes.end(), LayerChanges(),
                                         [](LayerChanges sum, const LayerChanges& plane) {
                                             sum += plane;
                                             return sum;
                                         }),
                         changed.planes.size(), contours);
        if (stack.parts.empty())
            return std::pair(parts.front(), found.texts());
        auto together = std::make_shared<Stack>(stack);
        together->parts = std::move(parts);
        return std::pair(std::move(together), found.texts());
    });
}

/// Returns the warnings, and the bytes of a file in memory.
std::pair<std::vector<std::string>, py::bytes> write_mesh(const std::string& path, const std::string& format,
                                                          const MeshPointer& mesh, const std::string& name,
                                                          bool strict, bool in_memory) {
    std::string memory;
    std::vector<std::string> warnings;
    {
        const GilRelease released;
        warnings = write_mesh_file(path, format, *mesh, name, strict, in_memory ? &memory : nullptr);
    }
    return {std::move(warnings), memory};
}

void set_reference(VerifyOptions& options, const SourcePlate& plate, const Execution& execution) {
    options.mesh = joined(plate.mended, execution);
    if (plate.apart || !plate.mended.negatives.empty())
        options.plate = plate.mended;
}

/// Adds the numbers of the findings of a check, and their texts.
void add_findings(py::dict& fields, const Findings& findings, FindingOrigin check) {
    for (const FindingNumber& number : findings.numbers(check))
        fields[number.key] = number.value;
    fields["gaps"] = findings.count(FindingKind::layer_gaps);
    fields["findings"] = findings.texts();
}

py::dict verified(const Stack& stack, const PlatePointer& plate, const std::string& at, double snap_mm,
                  double tolerance, std::optional<double> close_gaps_mm, const std::string& fill,
                  const InsetAndHeight& bottom_offset, unsigned threads, const py::object& progress) {
    if (holds_scan_vectors(stack))
        throw Error(ErrorKind::usage,
                    stack.path + " holds scan vectors, which lamella.verify_vectors checks");
    const Verification found = result_of(threads, progress, [&](const Execution& execution) {
        VerifyOptions options{.rule = stack.rule,
                              .snap_mm = snap_mm,
                              .close_gaps_mm = close_gaps_mm,
                              .rounding = stack.rounding,
                              .tolerance_mm = tolerance};
        options.steps.fill = fill_rule(fill);
        options.steps.bottom = bottom_inset(bottom_offset, 0); // the plate is the bottom of the mesh
        if (plate)
            set_reference(options, *plate, execution);
        LayerPart all{.layers = plain(stack.layers)};
        for (const LayerPointer& layer : stack.layers)
            all.hatches.push_back(layer->hatches());
        if (!at.empty())
            options.rule = place_cuts(all.layers, slice_at_named(at));
        return verify(source_of({std::move(all)}, stack.path, execution), options, execution);
    });
    py::dict fields;
    fields["ok"] = found.ok();
    fields["layers"] = found.layers;
    fields["contours"] = found.contours;
    fields["points"] = found.points;
    fields["volume"] = found.volume_mm3;
    fields["max_area_error"] = found.max_area_error_mm2;
    fields["areas_agree"] = found.findings.count(FindingKind::other_areas) == 0;
    add_findings(fields, found.findings, FindingOrigin::layers);
    return fields;
}

/// Returns the findings, and the warnings of the file.
std::pair<py::dict, std::vector<py::str>>
vectors_verified(const py::object& source, const PlatePointer& plate,
                 const std::optional<ScanStrategy>& strategy, const std::string& at, double snap_mm,
                 double tolerance, std::optional<double> close_gaps_mm, unsigned threads,
                 const py::object& progress) {
    const Input input(source);
    std::vector<std::string> warnings;
    const VectorVerification found = result_of(threads, progress, [&](const Execution& execution) {
        LayerFile file = input.read_by(
            [&](const auto&... from) { return read_layers(from..., LayerReadOptions{}, execution); });
        if (!holds_scan_vectors(file))
            throw Error(ErrorKind::usage,
                        input.name() + " holds no scan vectors; lamella.verify checks layers");
        VerifyOptions options{.rule = file.rule,
                              .snap_mm = snap_mm,
                              .close_gaps_mm = close_gaps_mm,
                              .rounding = file.rounding,
                              .tolerance_mm = tolerance};
        if (plate)
            set_reference(options, *plate, execution);
        options.strategy = strategy;
        if (!at.empty())
            options.rule = place_cuts(file, slice_at_named(at));
        warnings = std::move(file.warnings);
        return verify_vectors(file, options, execution);
    });
    py::dict fields;
    fields["ok"] = found.ok();
    fields["layers"] = found.layers;
    fields["contour_vectors"] = found.contour_vectors;
    fields["hatch_vectors"] = found.hatch_vectors;
    add_findings(fields, found.findings, FindingOrigin::vectors);
    fields["inverted_volume"] = fields.attr("pop")("inverted_mm3");
    return {fields, message_texts(warnings)};
}

py::list regions_of(const std::vector<PrintIsland>& islands) {
    py::list list;
    for (const PrintIsland& island : islands)
        list.append(py::make_tuple(island.layer, island.bottom_mm, island.top_mm,
                                   std::pair(island.centre.x, island.centre.y), island.area_mm2,
                                   island.largest_mm2, island.volume_mm3, island.joins, island.support));
    return list;
}

py::list regions_of(const std::vector<PrintCavity>& cavities) {
    py::list list;
    for (const PrintCavity& cavity : cavities)
        list.append(py::make_tuple(cavity.layer, cavity.bottom_mm, cavity.top_mm,
                                   std::pair(cavity.centre.x, cavity.centre.y), cavity.area_mm2,
                                   cavity.largest_mm2, cavity.volume_mm3, cavity.opens, cavity.on_plate));
    return list;
}

/// Returns the fields of a lamella.PrintCheck.
py::dict print_checked(const StackPointer& stack, double touch_mm2, double overhang_angle, unsigned threads,
                       const py::object& progress) {
    if (holds_scan_vectors(*stack))
        throw Error(ErrorKind::usage, stack->path + " holds scan vectors, not the material of layers");
    const PrintCheck found = result_of(threads, progress, [&](const Execution& execution) {
        std::vector<LayerPart> parts;
        for (const StackPointer& part : stack->parts.empty() ? std::vector{stack} : stack->parts)
            parts.push_back({.label = part->label, .layers = plain(part->layers), .support = part->support});
        return check_print(source_of(std::move(parts), stack->path, execution),
                           {.touch_mm2 = touch_mm2, .overhang_angle = overhang_angle}, execution);
    });
    py::dict fields;
    fields["ok"] = found.findings.first(Severity::warning) == nullptr;
    fields["islands"] = regions_of(found.islands);
    fields["cavities"] = regions_of(found.cavities);
    for (const auto& [name, value] : {std::pair{"area", &PeelArea::area_mm2},
                                      {"largest_area", &PeelArea::largest_mm2},
                                      {"perimeter", &PeelArea::perimeter_mm},
                                      {"exposed", &PeelArea::exposed_mm2},
                                      {"overhang_area", &PeelArea::overhang_mm2},
                                      {"overhang_width", &PeelArea::overhang_mm}}) {
        py::array_t<double> values(static_cast<py::ssize_t>(found.layers.size()));
        for (std::size_t i = 0; i < found.layers.size(); ++i)
            values.mutable_at(static_cast<py::ssize_t>(i)) = found.layers[i].*value;
        fields[name] = values;
    }
    fields["empty_layers"] = found.findings.count(FindingKind::empty_layers);
    fields["findings"] = found.findings.texts();
    return fields;
}

/// Returns the tolerance, a list of planes, and whether the stacks are cut at different heights. A plane has
/// the indices of its layers in the stacks, or None, and `same`, `agree`, the distance and its location.
py::tuple compared(const Stack& first, const Stack& second, std::optional<double> tolerance, unsigned threads,
                   const py::object& progress) {
    const StackComparison found = result_of(threads, progress, [&](const Execution& execution) {
        const LayerStack of_first = plain(first.layers);
        const LayerStack of_second = plain(second.layers);
        return compare(RoundedLayers{of_first, first.rounding}, {of_second, second.rounding}, tolerance,
                       execution);
    });
    py::list planes;
    for (const ComparedPlane& plane : found.planes) {
        const LayerDifference& difference = plane.difference;
        planes.append(py::make_tuple(plane.first, plane.second, difference.same, plane.agree,
                                     difference.distance_mm,
                                     std::pair(difference.where.x, difference.where.y)));
    }
    return py::make_tuple(found.tolerance_mm, planes, found.cut_apart);
}

/// Writes a page with all layers of the stack. Returns the warnings.
std::vector<py::str> write_page(const StackPointer& stack, const std::string& path) {
    const std::vector<StackPointer> stacks = stack->parts.empty() ? std::vector{stack} : stack->parts;
    const bool empty =
        std::all_of(stacks.begin(), stacks.end(), [](const StackPointer& part) { return part->box.empty(); });
    PartHeads parts;
    std::vector<std::vector<LayerPointer>> planes(stack->layers.size());
    for (const StackPointer& part : stacks) {
        const auto& [min, max] = empty ? shown_box(*part) : part->box;
        parts.emplace_back(part->label.empty() ? "part" : part->label,
                           Bounds{{{min.x, min.y, min.z}, {max.x, max.y, max.z}}}, part->exposure,
                           part->support);
        for (std::size_t i = 0; i < planes.size(); ++i)
            planes[i].push_back(part->layers[i]);
    }
    if (planes.empty())
        throw Error(ErrorKind::usage, "content: there are no layers to write");
    const auto writer = open_writer(path, "html", parts, planes.size(), stack->layers.front()->get().bottom,
                                    std::string(plane_rule_name(stack->rule)), {}, false);
    writer->write(planes, 0);
    return writer->finish();
}

} // namespace

void bind_files(py::module_& module) {
    const py::object stack = module.attr("Stack");
    stack.attr("_write_page") = py::cpp_function(&write_page, py::name("_write_page"), py::is_method(stack));
    module.def("read_layers", &read_stack);
    module.def("read_any", &read_either);
    module.def("after_steps", &after_steps);
    module.def("verify", &verified);
    module.def("verify_vectors", &vectors_verified);
    module.def("compare", &compared);
    stack.attr("_checked") = py::cpp_function(&print_checked, py::name("_checked"), py::is_method(stack));
    module.def("write_mesh", &write_mesh);
    py::class_<ResinSettings>(module, "ResinSettings").def(py::init(&resin_settings_of_tables));
    py::class_<StackWriter>(module, "StackWriter")
        .def("write", &StackWriter::write)
        .def("finish", &StackWriter::finish)
        .def("content", &StackWriter::content)
        .def("close", &StackWriter::close);
    module.def("open_writer", &open_writer);
    module.def("formats_with", &formats_with);
    module.def("layer_format", [](const std::string& name, const std::string& path) {
        return std::string(layer_format(name, path).name);
    });
    module.def("mesh_extensions", &mesh_extensions);
    module.def("layer_formats", [] {
        std::vector<std::tuple<std::string, std::string, std::string>> found;
        for (const LayerFormat& format : layer_formats())
            found.emplace_back(format.name, format.extension, format.summary);
        return found;
    });
}

} // namespace lamella::python
