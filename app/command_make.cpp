#include "lamella/core/error.hpp"
#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/meshes/mesh_file.hpp"
#include "lamella/meshes/mesh_writer.hpp"

#include "command_line.hpp"
#include "commands.hpp"
#include "names.hpp"
#include "numbers.hpp"
#include "options.hpp"
#include "parts/shapes.hpp"
#include "standard_streams.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella::app {
namespace {

struct MakeArguments {
    std::string body;
    std::string output;
    bool ascii = false;

    std::optional<std::uint64_t> holes;
    std::optional<std::uint64_t> segments;
    std::optional<std::vector<double>> size;
    std::optional<double> thickness;
    std::optional<std::uint64_t> cells;
    std::optional<std::uint64_t> detail;
    std::string order;
    std::optional<std::uint64_t> shuffle;

    PlacementOptions pose;
};

unsigned as_unsigned(const std::optional<std::uint64_t>& given, unsigned otherwise, std::string_view option) {
    if (!given)
        return otherwise;
    if (*given > std::numeric_limits<unsigned>::max())
        throw Error(ErrorKind::usage, fmt::format("--{}: {} are too many", option, *given));
    return static_cast<unsigned>(*given);
}

double single_size(const MakeArguments& arguments, double otherwise) {
    if (!arguments.size)
        return otherwise;
    if (arguments.size->size() != 1)
        throw Error(ErrorKind::usage, fmt::format("--size: a {} takes one length{}", arguments.body,
                                                  arguments.body == "box" ? ", or three" : ""));
    return arguments.size->front();
}

TriangleSoup sheet(const MakeArguments& arguments) {
    SheetShape shape;
    shape.holes = as_unsigned(arguments.holes, shape.holes, "holes");
    shape.segments = as_unsigned(arguments.segments, shape.segments, "segments");
    shape.size_mm = single_size(arguments, shape.size_mm);
    shape.thickness_mm = arguments.thickness.value_or(shape.thickness_mm);
    if (arguments.order == "hole")
        shape.order = TriangleOrder::hole;
    if (arguments.order == "split")
        shape.order = TriangleOrder::split;
    if (arguments.order == "shuffle") {
        shape.order = TriangleOrder::shuffle;
        shape.seed = arguments.shuffle.value_or(shape.seed);
    }
    return make_sheet(shape);
}

/// Returns a body without parameters.
template <TriangleSoup (*make)()>
TriangleSoup fixed(const MakeArguments& /*arguments*/) {
    return make();
}

LatticeShape lattice_shape(const MakeArguments& arguments) {
    LatticeShape shape;
    const unsigned cells = as_unsigned(arguments.cells, shape.cells_x, "cells");
    shape.cells_x = shape.cells_y = shape.cells_z = cells;
    shape.cell_mm = single_size(arguments, shape.cell_mm);
    shape.strut_mm = arguments.thickness.value_or(shape.strut_mm);
    shape.detail = as_unsigned(arguments.detail, shape.detail, "detail");
    return shape;
}

TriangleSoup lattice(const MakeArguments& arguments) {
    return make_lattice(lattice_shape(arguments));
}

TriangleSoup box(const MakeArguments& arguments) {
    if (arguments.size && arguments.size->size() == 3)
        return make_box((*arguments.size)[0], (*arguments.size)[1], (*arguments.size)[2]);
    const double edge = single_size(arguments, 20);
    return make_box(edge, edge, edge);
}

TriangleSoup sphere(const MakeArguments& arguments) {
    return make_sphere(single_size(arguments, 20) / 2, as_unsigned(arguments.detail, 5, "detail"));
}

TriangleSoup torus(const MakeArguments& arguments) {
    const double size = single_size(arguments, 40);
    const double tube = arguments.thickness.value_or(size / 4);
    const unsigned segments = as_unsigned(arguments.segments, 128, "segments");
    return make_torus((size - tube) / 2, tube / 2, segments, std::max(segments / 2, 3U));
}

TriangleSoup cylinder(const MakeArguments& arguments) {
    const double size = single_size(arguments, 20);
    return make_cylinder(size / 2, arguments.thickness.value_or(size),
                         as_unsigned(arguments.segments, 128, "segments"));
}

struct Body {
    std::string_view name;
    std::string_view options; ///< supported options in addition to the common ones
    TriangleSoup (*make)(const MakeArguments& arguments);
};
constexpr std::array<Body, 11> bodies{{{"sheet", "holes segments size thickness order", sheet},
                                       {"rook", "", fixed<make_rook>},
                                       {"dodecahedra", "", fixed<make_dodecahedra>},
                                       {"calibration", "", fixed<make_calibration>},
                                       {"head", "", fixed<make_head>},
                                       {"sole", "", fixed<make_sole>},
                                       {"lattice", "cells size thickness detail", lattice},
                                       {"box", "size", box},
                                       {"sphere", "size detail", sphere},
                                       {"torus", "size thickness segments", torus},
                                       {"cylinder", "size thickness segments", cylinder}}};

constexpr std::string_view shape_title = "Shape";

/// Rejects an option that this body would ignore.
void check_options(const Body& body, const Command& command) {
    const auto understands = [&](const Option& option) {
        return fmt::format(" {} ", body.options).find(fmt::format(" {} ", option.name)) != std::string::npos;
    };
    for (const OptionGroup& group : command.groups)
        for (const Option& option : group.options)
            if (group.title == shape_title && option.given && !understands(option))
                throw Error(ErrorKind::usage,
                            body.options.empty()
                                ? fmt::format("--{}: {} has none: its shape is fixed; use --scale",
                                              option.name, body.name)
                                : fmt::format("--{}: a {} has none; it has: {}", option.name, body.name,
                                              body.options));
}

OptionGroup shape_options(MakeArguments& target) {
    return {
        "shape",
        std::string(shape_title),
        {count("holes", "N", "sheet: number of holes, a square such as 100, 225 or 1225", target.holes),
         count("segments", "N", "sheet: corners of a hole; torus, cylinder: around the axis",
               target.segments),
         row("size", ValueKind::numbers, "MM|X,Y,Z",
             "sheet: edge; lattice: cell; sphere, torus, cylinder: diameter; box: edge or edges",
             [&target](const std::string& text) { target.size = parse_numbers(text); }),
         length("thickness",
                "sheet: thickness; lattice: diameter of a strut; torus: of the tube; cylinder: height",
                target.thickness),
         count("cells", "N", "lattice: cells along each axis", target.cells),
         count("detail", "N", "lattice, sphere: fineness; the number of triangles grows fast with it",
               target.detail),
         choice(
             "order", "HOW",
             "sheet: order of the triangles: wall by wall, hole by hole with the lower ones first, all lower "
             "ones first (hard for some algorithms), or random (with the seed of --shuffle, or 1)",
             {"wall", "hole", "split", "shuffle"}, target.order)}};
}

/// Writes the mesh in the format of the extension, STL by default.
void write_mesh(const std::string& output, const TriangleSoup& soup, const MakeArguments& arguments) {
    const std::string extension = extension_of(output);
    if (arguments.ascii && extension == ".ply")
        throw Error(ErrorKind::usage,
                    "--ascii: PLY files are written as binary; STL and OBJ have a text form");
    if (extension == ".ply")
        write_ply(output, weld(soup));
    else if (extension == ".obj")
        write_obj(output, weld(soup), arguments.body);
    else if (arguments.ascii)
        write_stl_ascii(output, soup, arguments.body);
    else
        write_stl(output, soup);
}

struct Made {
    std::uint64_t triangles = 0;
    Box3 box;
};

/// Writes a lattice while it is generated, because it may be larger than memory.
Made stream_lattice(const std::string& output, const MakeArguments& arguments, const Transform& pose) {
    const LatticeShape shape = lattice_shape(arguments);
    Made made{.triangles = lattice_triangles(shape), .box = {}};
    StlWriter writer(output, made.triangles);
    make_lattice(shape, [&](const TriangleSoup& level) {
        const TriangleSoup placed = level.transformed(pose);
        made.box.add(bounding_box(placed));
        writer.append(placed);
    });
    writer.finish();
    return made;
}

Made make_whole(const std::string& output, const MakeArguments& arguments, const Body& body,
                const Transform& pose) {
    TriangleSoup soup = body.make(arguments);
    if (arguments.shuffle && arguments.order != "shuffle")
        soup = shuffled(soup, *arguments.shuffle);
    soup = soup.transformed(pose);
    write_mesh(output, soup, arguments);
    return {soup.size(), bounding_box(soup)};
}

/// Returns whether the body is written to a binary STL file while it is generated.
bool can_stream(const std::string& output, const MakeArguments& arguments) {
    const std::string extension = extension_of(output);
    return arguments.body == "lattice" && !arguments.shuffle && !arguments.ascii && extension != ".ply" &&
           extension != ".obj";
}

int run_make(const MakeArguments& arguments, const Context& context) {
    const Body& body = *std::find_if(bodies.begin(), bodies.end(),
                                     [&](const Body& one) { return one.name == arguments.body; });
    check_options(body, context.command);
    const Transform pose = arguments.pose.pose();
    const std::string output = arguments.output.empty() ? arguments.body + ".stl" : arguments.output;

    check_outputs(context.command, arguments.output.empty() ? std::vector<NamedFile>{{"the body", output}}
                                                            : std::vector<NamedFile>{});
    const Made made = can_stream(output, arguments) ? stream_lattice(output, arguments, pose)
                                                    : make_whole(output, arguments, body, pose);
    const Box3& extent = made.box;
    const std::string text =
        fmt::format("{}: {}, {}, {} x {} x {} mm\n", one_line(output_name(output)), arguments.body,
                    counted(made.triangles, "triangle"), brief(extent.max.x - extent.min.x),
                    brief(extent.max.y - extent.min.y), brief(extent.max.z - extent.min.z));
    context.messages.written(text, output);
    return 0;
}

} // namespace

Command make_command() {
    const auto arguments = std::make_shared<MakeArguments>();
    Option output = output_file(
        "output",
        "the file: STL, or PLY or OBJ by its extension; - is standard output (default: BODY.stl in this "
        "folder)",
        arguments->output, {".stl", ".ply", ".obj"});
    output.letter = 'o';
    return {
        .name = "make",
        .summary = "make a test part: a sheet with holes, a chess rook, ...",
        .description = "Writes a closed test part. The same options give the same bytes on every machine. "
                       "Options that do "
                       "not apply to the body are refused.",
        .operands = {{.placeholder = "BODY",
                      .help = "the body",
                      .choices = names_of(bodies),
                      .set =
                          [arguments](const std::string& text) {
                              arguments->body = text;
                          }}},
        .groups = {{"output",
                    "Output",
                    {std::move(output), flag("ascii", "write text instead of binary data", arguments->ascii),
                     count("shuffle", "SEED", "put the triangles in a random order", arguments->shuffle)}},
                   shape_options(*arguments),
                   pose_options(arguments->pose),
                   common_options(true)},
        .examples = {{"lamella make rook", "writes rook.stl"},
                     {"lamella make rook -o rook.obj", "the same as OBJ, with shared vertices"},
                     {"lamella make sheet --holes 1225 -o sheet.stl", "2.5 million triangles"},
                     {"lamella make sheet --holes 100 --rotate-x 90", "a sheet on its edge"},
                     {"lamella make lattice --cells 61", "102 million triangles, 5 GB"},
                     {"lamella make sole", "struts from bottom to top: 860,000 long triangles"},
                     {"lamella make box --size 20,30,2.5 --ascii", "a small text file"}},
        .run = [arguments](const Context& context) {
            return run_make(*arguments, context);
        }};
}

} // namespace lamella::app
