#pragma once

// Writing slice files: Common Layer Interface, SVG, pictures.

#include "lamella/contour/exposure.hpp"
#include "lamella/contour/layer.hpp"
#include "lamella/contour/plane_rule.hpp"
#include "lamella/contour/rounding.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/core/point.hpp"
#include "lamella/write/picture_options.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// One of the parts whose layers a file holds, or one exposure of a part.
struct PartInfo {
    std::string label = "part";
    Box3 box = {}; ///< mm; empty where nothing is known
    /// Where set, its layers are scan vectors; see `scan`.
    std::optional<Exposure> exposure = {};
    bool support = false; ///< is exposed as one in scan vectors; 3MF marks it
};

/// Of the contours and hatch lines of a part, from the bottom of its first layer to the top of its last;
/// empty where there are none. O(points).
[[nodiscard]] Box3 part_box(std::span<const Layer> layers) noexcept;

/// A piece of a slice file, for formats whose files are layers one after the other (LayerFormat::pieces):
/// several processes write one file so. The pieces of a file, put together, are the file.
struct LayerFilePiece {
    std::uint64_t before = 0; ///< layers of the file before those of the piece
    std::uint64_t layers = 0; ///< of the piece
    /// Takes its bytes, in order.
    std::function<void(std::string_view)> put;
};

/// What the head of a slice file says, known before the first layer is.
struct LayerFileInfo {
    Box3 box = {};                   ///< of all parts, mm; never empty
    std::uint64_t layers = 0;        ///< how many planes will follow
    double bottom = 0;               ///< of the first layer
    std::vector<PartInfo> parts{{}}; ///< at least one
    /// By which all layers were cut; formats that keep cuts keep it, too.
    PlaneRule rule = PlaneRule::section_above;
    /// Where set: only this piece is written, not to a file. It must outlive the writer.
    const LayerFilePiece* piece = nullptr;
    /// All layers pass `check`, as those of `slice` do: the writer need not look at every point.
    bool known_finite = false;
};

/// html: see lamella/write/layer_page.hpp.
struct PageOptions {
    /// The built viewer, an HTML page with a place for the data: the text of share/lamella/viewer.html of an
    /// installation. It must outlive the writer.
    std::string_view viewer = {};
    /// Why `viewer` is empty, for the error when a page is asked for. It must outlive the options.
    std::string_view no_viewer = "PageOptions::viewer is empty";
    /// What the page calls itself.
    std::string title = "Lamella";
    /// Most bytes of the page that all layers take, and most points of one layer. Layers are thinned out to
    /// stay within both.
    std::uint64_t budget_bytes = std::uint64_t{24} << 20;
    std::uint64_t layer_points = 250'000;
};

struct LayerWriteOptions {
    static constexpr double usual_units_mm = 0.001;

    /// Error{limit} where the layers take more bytes than this; 0 is no limit. What ends a file, such as
    /// the directory of an archive, does not count.
    std::uint64_t most_bytes = 0;
    /// Error{defect} in place of a file that would have warnings (LayerWriter::warnings).
    bool strict = false;
    /// Common Layer Interface: millimetres per coordinate unit. Coordinates are rounded to multiples of it in
    /// the ASCII and the short binary form; the long binary form keeps single precision.
    double units_mm = usual_units_mm;
    /// Common Layer Interface, binary: 16-bit coordinates; Error{usage} where they do not fit.
    bool short_form = false;
    /// png, png-zip, sl1, sl1s.
    PictureOptions picture = {};
    /// sl1, sl1s.
    ExposureOptions exposure = {};
    /// html.
    PageOptions page = {};
};

class LayerWriter;

/// All there is to say of a format. Its row is in src/write/layer_writer.cpp.
struct LayerFormat {
    std::string_view name;      ///< as in `--format`
    std::string_view extension; ///< with the dot; "" when the format is only chosen by name
    std::string_view summary;   ///< one line for help texts, quantisation included
    /// Called by open_layer_writer.
    std::unique_ptr<LayerWriter> (*open)(const std::string& path, const LayerFileInfo& info,
                                         const LayerWriteOptions& options) = nullptr;
    /// Of files that get their names from a program, where it is not `extension`.
    std::string_view file_extension = extension;
    bool directory = false;    ///< writes one file per layer into a directory
    bool pieces = false;       ///< can be written piece by piece
    bool joins = false;        ///< files of consecutive layers can be put together as they are
    bool one_way = false;      ///< layers cannot be read back
    bool filled_parts = false; ///< files know only those parts that have something in them
    bool cuts = false;         ///< keeps where layers were cut; readers of other formats take the middle
    /// Of coordinates, with the options as they are by default; none where contours are not kept as such.
    std::optional<Rounding> rounding = {};

    // What of LayerWriteOptions it takes.
    bool units = false;
    bool short_form = false;
    bool picture = false;
    bool exposure = false;
};

/// All formats, in the order in which help lists them.
[[nodiscard]] std::span<const LayerFormat> layer_formats() noexcept;

/// By name; by extension of the path where the name is empty. Throws Error{usage} that lists what there is.
[[nodiscard]] const LayerFormat& layer_format(std::string_view name, const std::string& path);

/// Writes one slice file. Layers must arrive in ascending z. Nothing appears at the path before `finish`:
/// data wait in the same folder, in a file without a name or, where the file system has none, of a hidden
/// one, of which nothing is left when the writer is destroyed unfinished.
/// "-" writes standard output.
class LayerWriter {
  public:
    LayerWriter() = default;
    LayerWriter(const LayerWriter&) = delete;
    LayerWriter& operator=(const LayerWriter&) = delete;
    virtual ~LayerWriter() = default;

    /// Formats what one plane yields: one layer for each part, in the order of LayerFileInfo::parts, all with
    /// the same index, z, bottom and top, and empty where the plane misses the part. Formats that cannot keep
    /// parts apart put them together. May be called for several planes at once, from any threads, in any
    /// order. The function it returns writes the result; those must be called one at a time in ascending z
    /// (see LayerSink).
    [[nodiscard]] virtual std::function<void()> prepare(std::span<const Layer> parts) = 0;

    /// The same for the only part.
    [[nodiscard]] std::function<void()> prepare(const Layer& layer) { return prepare(std::span(&layer, 1)); }

    /// Ends the file and gives it its name. Throws Error{output} when anything could not be written, and
    /// leaves nothing behind. To be called once, after the last layer.
    virtual void finish() = 0;

    /// Bytes of the file so far, with those of layers that wait for their place in it.
    [[nodiscard]] virtual std::uint64_t bytes() const noexcept = 0;

    /// What the format had no place for, contours and lines that its rounding lost, and how far it moves
    /// points where that is more than 0.01 mm, one line each. To be asked once all layers are written.
    [[nodiscard]] virtual std::vector<std::string> warnings() const { return {}; }
};

/// Throws Error{output} when the file cannot be created there, Error{usage} for impossible options.
[[nodiscard]] std::unique_ptr<LayerWriter> open_layer_writer(const std::string& path,
                                                             const LayerFormat& format,
                                                             const LayerFileInfo& info,
                                                             const LayerWriteOptions& options = {});

/// Has `planes` planes formatted on all threads and written in order; the first one is the writer's next.
/// `parts_of(i)` gives the layers of plane i, one for each part (see LayerWriter::prepare); it may be called
/// for several planes at once. Each thread holds one plane. Throws what these throw, and Error{cancelled}.
void write_planes(LayerWriter& writer, std::size_t planes,
                  const std::function<std::vector<Layer>(std::size_t)>& parts_of,
                  const Execution& execution = {});

/// Writes the stack of a single part, in the format that the extension of the path names, and returns
/// LayerWriter::warnings. What the head of the file says is taken from the layers: the box is that of their
/// contours, and the rule that of slice() by default. Throws Error{usage} where there are no layers.
std::vector<std::string> write_layers(const std::string& path, std::span<const Layer> layers,
                                      const LayerWriteOptions& options = {}, const Execution& execution = {});

/// The same in any format, with a head of the caller's. Formats on all threads; layers need not be in memory
/// for that: `slice_to` takes LayerWriter::prepare as its sink.
std::vector<std::string> write_layers(const std::string& path, const LayerFormat& format,
                                      std::span<const Layer> layers, const LayerFileInfo& info,
                                      const LayerWriteOptions& options = {}, const Execution& execution = {});

/// The same for several parts, whose stacks have the same planes: Error{usage} names the first layer with
/// another index or other heights than that of the first part.
std::vector<std::string> write_layers(const std::string& path, const LayerFormat& format,
                                      std::span<const LayerStack> parts, const LayerFileInfo& info,
                                      const LayerWriteOptions& options = {}, const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
