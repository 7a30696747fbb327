#pragma once

// Writers of slice files, in all formats of `layer_formats`.

#include "lamella/contour/plane_source.hpp"
#include "lamella/core/commit.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/core/point.hpp"
#include "lamella/findings/findings.hpp"
#include "lamella/slices/image_options.hpp"
#include "lamella/slices/resin_printer.hpp"
#include "lamella/slices/resin_settings.hpp"

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

/// Returns the box of the contours and hatch lines of a part, from the bottom of its first layer to the top
/// of its last. It is empty if there are none. O(points), parallel. Throws Error{cancelled}.
[[nodiscard]] Box3 part_box(std::span<const Layer> layers, std::span<const PointArray> hatches = {},
                            const Execution& execution = {.threads = 1});

/// Losses in a range of layers, including those that only other formats have.
struct WriteLosses {
    /// Findings of FindingOrigin::output that belong to layers.
    Findings found;

    // The range itself, by which gaps between two ranges are found.
    std::uint64_t layers = 0;
    double first_z = 0; ///< z of the first layer
    double bottom = 0;  ///< bottom of the first layer
    double top = 0;     ///< top of the last layer

    /// Adds the losses of layers above these, and a gap if they do not begin at the top of these.
    void add(const WriteLosses& above);
};

/// A range of the layers of a slice file. Several processes can write one file if the format stores layers
/// one after the other (LayerFormat::chunks): the file is the concatenation of the ranges. The writer of the
/// first range reports the warnings of the file after the losses of the other ranges are added to it.
struct LayerFileChunk {
    std::uint64_t before = 0; ///< number of layers of the file below this range
    std::uint64_t layers = 0; ///< number of layers of this range
    /// Takes the bytes of the range, in order. If there is an owner, it keeps the bytes alive, and a
    /// completion may use them later; otherwise this function must copy them.
    std::function<void(std::string_view, std::shared_ptr<const void> owner, Completions& after)> put;
};

/// Content of the header of a slice file, known before the first layer.
struct LayerFileInfo {
    Box3 box = {};                   ///< of all parts, mm; never empty
    std::uint64_t layers = 0;        ///< number of planes that will follow
    double bottom = 0;               ///< of the first layer
    std::vector<PartInfo> parts{{}}; ///< at least one
    /// Rule by which all layers were cut. Formats that store the heights of cuts also store this rule.
    PlaneRule rule = PlaneRule::section_above;
    /// If set, only this range is written, to LayerFileChunk::put instead of a file. It must outlive the
    /// writer.
    const LayerFileChunk* chunk = nullptr;
    /// If set, each plane has an image with these pixels (see PlaneSource::grid), and formats of images write
    /// these pixels. The display of the options must then have as many.
    std::optional<PixelGrid> grid = {};
    std::string printer = {}; ///< name of the printer for which these images were made; may be ""
    /// If set, the bytes of the file replace the content of this string, and no file is made. The path is
    /// then only a name for errors. It must outlive the writer.
    std::string* memory = nullptr;
    /// True if all layers are known to pass `check`, as those of `slice` do. The writer then does not check
    /// every point.
    bool known_finite = false;
};

/// Returns the header of a file with the planes of this source. Parts without a label get the default of
/// PartInfo. The box extends from the bottom of the first plane to the top of the last. Throws Error{input}
/// if there are no planes.
[[nodiscard]] LayerFileInfo info_of(const PlaneSource& source);

/// Options of the format html: see lamella/slices/layer_page.hpp.
struct PageOptions {
    /// The built viewer, an HTML page with a placeholder for the data: the text of share/lamella/viewer.html
    /// of an installation. It must outlive the writer.
    std::string_view viewer = {};
    /// Reason why `viewer` is empty, which the error message reports. It must outlive the options.
    std::string_view no_viewer = "PageOptions::viewer is empty";
    /// Title of the page.
    std::string title = "Lamella";
    /// Upper bounds on the bytes of all layers in the page, and on the points of one layer. Layers lose hatch
    /// lines, points and small rings to stay within both bounds.
    std::uint64_t budget_bytes = std::uint64_t{24} << 20;
    std::uint64_t layer_points = 250'000;
};

struct LayerWriteOptions {
    static constexpr double usual_units_mm = 0.001;

    /// Upper bound on the bytes of the layers in the file; otherwise Error{limit} is thrown. 0: no limit. The
    /// end of a file, such as the directory of an archive, does not count.
    std::uint64_t most_bytes = 0;
    /// If true, `finish` throws Error{defect} if there are findings.
    bool strict = false;
    /// Limits of the unions that geojson computes of a layer.
    LayerLimits limits = {};
    /// Common Layer Interface: millimetres per coordinate unit. The ASCII and the short binary form round
    /// coordinates to multiples of it; the long binary form rounds to single precision.
    double units_mm = usual_units_mm;
    /// Common Layer Interface, binary: writes 16-bit coordinates. Error{usage} if the coordinates do not fit.
    bool short_form = false;
    /// Options of the formats with LayerFormat::image.
    ImageOptions image = {};
    /// Printer whose display the images are for. Formats for printers need it, or the pixels of the display
    /// in `image`. It must outlive the writer.
    const ResinPrinter* printer = nullptr;
    /// Options of the formats with LayerFormat::exposure.
    ResinSettings resin = {};
    /// True if these settings come from the file that is converted. What the format cannot hold of them is
    /// then left out with a warning; otherwise it is an error.
    bool resin_of_file = false;
    /// Options of the format html.
    PageOptions page = {};
};

class LayerWriter;
struct ResinJob;

/// Properties of a format. Its row is in src/slices/engine/slice_formats.cpp.
struct LayerFormat {
    std::string_view name;      ///< the argument of `--format`
    std::string_view extension; ///< with the dot; "" if the format can only be chosen by name
    std::string_view summary;   ///< one line for help texts, with the rounding
    /// Called by open_layer_writer.
    std::unique_ptr<LayerWriter> (*open)(const std::string& path, const LayerFileInfo& info,
                                         const LayerWriteOptions& options) = nullptr;
    /// Extension of file names that a program generates; differs from `extension` for some formats.
    std::string_view file_extension = extension;
    /// Further extensions that determine the format, with blanks between them.
    std::string_view more_extensions = {};
    bool directory = false;    ///< writes one file per layer into a directory
    bool chunks = false;       ///< ranges of layers can be written separately, and compressed with gzip
    bool joins = false;        ///< files of consecutive layers can be merged without reading the layers
    bool one_way = false;      ///< layers cannot be read back
    bool filled_parts = false; ///< files list only parts that are not empty
    bool cuts = false;         ///< stores the heights of cuts; otherwise readers assume the middle
    /// Rounding of coordinates with the default options; nullopt if the format does not store contours.
    std::optional<Rounding> rounding = {};

    // Fields of LayerWriteOptions that apply to the format.
    bool units = false;
    bool short_form = false;
    bool image = false;
    bool part_colours = false; ///< of ImageOptions; other formats with images ignore them
    bool exposure = false;
};

/// Returns all formats, in the order in which help lists them.
[[nodiscard]] std::span<const LayerFormat> layer_formats() noexcept;

/// Returns the format of this name or, if the name is empty, of the extension of the path. Throws
/// Error{usage}, which lists the formats.
[[nodiscard]] const LayerFormat& layer_format(std::string_view name, const std::string& path);

/// Writes one slice file. Layers must arrive in ascending z. No file appears at the path before `finish`:
/// until then data are in an unnamed file in the same folder. If the file system does not support unnamed
/// files, they are in a hidden file. A writer destroyed before `finish` leaves no file behind. "-" writes
/// standard output.
class LayerWriter {
  public:
    LayerWriter() = default;
    LayerWriter(const LayerWriter&) = delete;
    LayerWriter& operator=(const LayerWriter&) = delete;
    virtual ~LayerWriter() = default;

    /// Formats one plane, which has the parts of LayerFileInfo::parts, in this order; the layer of a part
    /// that the plane misses is empty. Formats that cannot distinguish parts merge them. The commit writes
    /// the result.
    [[nodiscard]] virtual Commit prepare(const Plane& plane) = 0;

    /// Ends the file and gives it its name. Must be called once, after the last layer. Throws Error{output}
    /// if anything could not be written; in this case no file is left behind.
    virtual void finish() = 0;

    /// Returns the number of bytes of the file so far, including layers that are still waiting to be written.
    [[nodiscard]] virtual std::uint64_t bytes() const noexcept = 0;

    /// Returns the content that the format cannot represent, contours and lines lost by rounding, and the
    /// largest displacement of points by rounding if it exceeds 0.01 mm: findings of FindingOrigin::output.
    /// Must be called after all layers are written.
    [[nodiscard]] virtual Findings findings() const { return {}; }
    /// Returns their texts.
    [[nodiscard]] std::vector<std::string> warnings() const { return findings().texts(); }

    /// Returns the printer, the settings and the amounts of a job for a resin printer, without exposures;
    /// null in other formats. Must be called after `finish`.
    [[nodiscard]] virtual const ResinJob* resin_job() const noexcept { return nullptr; }

    /// Returns the losses behind `findings`, for the writer of another range of the file.
    [[nodiscard]] virtual WriteLosses losses() const { return {}; }

    /// Adds the losses of a range above this one (LayerFileChunk) to those that `findings` returns.
    virtual void add_losses(const WriteLosses& /*above*/) {}
};

/// Opens a writer. Throws Error{output} if the file cannot be created at the path, and Error{usage} for
/// invalid options.
[[nodiscard]] std::unique_ptr<LayerWriter> open_layer_writer(const std::string& path,
                                                             const LayerFormat& format,
                                                             const LayerFileInfo& info,
                                                             const LayerWriteOptions& options = {});

/// Formats the next planes of the file on all threads, and writes them in order. Throws the errors of the
/// writer, and Error{cancelled}.
void write_planes(LayerWriter& writer, std::span<const Plane> planes, const Execution& execution = {});

/// Writes the stack of a single part, in the format given by the extension of the path, and returns
/// LayerWriter::warnings. The header is derived from the layers: its box is that of their contours, and its
/// rule is section_above. Throws Error{usage} if there are no layers.
std::vector<std::string> write_layers(const std::string& path, std::span<const Layer> layers,
                                      const LayerWriteOptions& options = {}, const Execution& execution = {});

/// Writes planes in any format, with a header supplied by the caller. Uses all threads. To write planes
/// without holding all of them in memory, call LayerWriter::prepare in the sink of `slice_to` or
/// PlaneSource::run. Returns LayerWriter::warnings.
std::vector<std::string> write_layers(const std::string& path, const LayerFormat& format,
                                      std::span<const Plane> planes, const LayerFileInfo& info,
                                      const LayerWriteOptions& options = {}, const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
