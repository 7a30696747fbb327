// The header is text of at most 2048 bytes that ends with 0D 0A 1A, or at least with 1A. 256 reserved bytes,
// the sampling table and the layers follow. A layer consists of the z of its bottom, the number of its
// contours, and the contours. The number 2^32 - 1 ends the file; its z is the top of the part.

#include "lamella/core/error.hpp"

#include "container/text_position.hpp"
#include "container/xml.hpp"
#include "core/executor.hpp"
#include "core/lower_case.hpp"
#include "read/layer_assembly.hpp"
#include "read/layer_pieces.hpp"
#include "read/layer_readers.hpp"
#include "read/read_limits.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

namespace lamella {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are read as memory has them");

constexpr std::size_t longest_header = 2048;
constexpr std::size_t reserved = 256;
constexpr std::uint32_t no_more_layers = 0xFFFFFFFF;
constexpr char header_end = '\x1a';

std::string_view header_of(std::string_view bytes) {
    const std::string_view begin = bytes.substr(0, longest_header);
    std::size_t end = begin.find("\r\n\x1a");
    if (end == std::string_view::npos)
        end = begin.find(header_end);
    return end == std::string_view::npos ? std::string_view() : begin.substr(0, end);
}

/// Returns the text between a keyword, given in lower case, and the next keyword. Some writers omit the
/// blanks around it.
std::optional<std::string_view> value_of(std::string_view header, std::string_view keyword) {
    const std::string lower = lower_case(header);
    const std::size_t at = lower.find(keyword);
    if (at == std::string::npos)
        return std::nullopt;
    std::size_t begin = at + keyword.size();
    if (begin < header.size() && lower[begin] == 's') // -UNITS
        ++begin;
    std::size_t end = begin;
    while (end < header.size() &&
           !(header[end] == '-' && end + 1 < header.size() && lower[end + 1] >= 'a' && lower[end + 1] <= 'z'))
        ++end;
    return trimmed(header.substr(begin, end - begin));
}

/// A cursor over the bytes.
class SlcBytes {
  public:
    SlcBytes(std::string_view bytes, std::size_t at, const std::string& name)
        : bytes_(bytes), at_(at), name_(name) {}

    [[noreturn]] void fail(std::size_t at, const std::string& found, const std::string& expected) const {
        throw Error(ErrorKind::input, fmt::format("{}, byte {}: found {}; {}", name_, at, found, expected));
    }

    [[nodiscard]] std::size_t at() const { return at_; }
    [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }
    [[nodiscard]] const char* data() const { return bytes_.data() + at_; }
    void skip(std::size_t bytes) { at_ += bytes; }

    template <class T>
    T take(const char* what) {
        T value;
        if (left() < sizeof value)
            fail(at_, fmt::format("the end of the file within {}", what), "the file is truncated");
        std::memcpy(&value, data(), sizeof value);
        at_ += sizeof value;
        return value;
    }

    /// Takes a length in units of the file.
    double length(const char* what) {
        const std::size_t at = at_;
        const auto value = static_cast<double>(take<float>(what));
        if (!std::isfinite(value))
            fail(at, fmt::format("a number that is not finite in {}", what), "it must be a length");
        return value;
    }

  private:
    std::string_view bytes_;
    std::size_t at_;
    const std::string& name_;
};

constexpr std::size_t point_size = 2 * sizeof(float);

/// Returns where pieces begin, which is at a layer. Ends at the first layer that is not sound.
PieceBegins pieces_of(std::string_view bytes, std::size_t begin) {
    PieceBegins begins{begin};
    const auto number = [&](std::size_t at) {
        std::uint32_t value = 0;
        std::memcpy(&value, bytes.data() + at, sizeof value);
        return value;
    };
    constexpr std::size_t fields = 2 * sizeof(std::uint32_t); // of a layer and of a contour
    for (std::size_t at = begin; bytes.size() - at >= fields;) {
        add_piece(begins, at);
        std::uint32_t contours = number(at + sizeof(float));
        if (contours == no_more_layers)
            break;
        for (at += fields; contours > 0 && bytes.size() - at >= fields; --contours) {
            const std::size_t points = number(at);
            at += fields;
            if (points > (bytes.size() - at) / point_size)
                return begins;
            at += points * point_size;
        }
    }
    return begins;
}

/// Consecutive layers.
struct SlcPiece {
    std::vector<RawLayer> layers = {};
    UnclosedContours unclosed = {};
    CountedWarning gaps{"contour has gaps, which were taken for lines",
                        "contours have gaps, which were taken for lines"};
    DroppedContours dropped = {};
    std::size_t end = 0;
    std::optional<double> top = {}; ///< of the part, if the piece has the mark of the end

    void append(SlcPiece&& later, ReadLimits& limits) {
        append_layers(layers, std::move(later.layers), limits);
        unclosed.add(later.unclosed);
        gaps.add(later.gaps);
        dropped.add(later.dropped);
        end = later.end;
        top = later.top;
    }
};

/// Properties that all layers share.
struct SlcLayers {
    double units_mm = 1;
    bool open = false; ///< true if contours may be open
};

/// Reads pieces of a file.
class SlcPieceReader {
  public:
    SlcPieceReader(std::string_view bytes, const std::string& name, const SlcLayers& layers,
                   ReadLimits& limits, const Executor& executor, ProgressMeter& progress)
        : bytes_(bytes), name_(name), units_mm_(layers.units_mm), open_(layers.open), limits_(limits),
          executor_(executor), progress_(progress) {}

    /// Reads layers from `begin` up to `limit`, or the mark of the end.
    [[nodiscard]] SlcPiece read(std::size_t begin, std::size_t limit) const {
        SlcBytes in(bytes_, begin, name_);
        SlcPiece piece;
        std::size_t reported = begin;
        const auto report_progress = [&] {
            if (in.at() - reported <= (std::size_t{1} << 22))
                return;
            executor_.check_cancelled();
            progress_.add(in.at() - reported);
            reported = in.at();
        };
        while (in.at() < limit) {
            const std::size_t at = in.at();
            const double z = in.length("a layer") * units_mm_;
            const auto contours = in.take<std::uint32_t>("a layer");
            if (contours == no_more_layers) {
                piece.top = z;
                break;
            }
            if (contours > in.left() / (2 * sizeof(std::uint32_t)))
                in.fail(at, fmt::format("a layer of {} contours", contours),
                        fmt::format("{} bytes are left in the file", in.left()));
            limits_.make_room(piece.layers, 1, at_byte(at));
            RawLayer& layer = piece.layers.emplace_back();
            layer.z = z;
            layer.location = fmt::format("byte {}", at);
            layer.begin = at;
            for (std::uint32_t i = 0; i < contours; ++i)
                read_contour(in, layer, piece, report_progress);
        }
        progress_.add(in.at() - reported);
        piece.end = in.at();
        drop_contents(piece.layers, limits_);
        return piece;
    }

  private:
    template <class Report>
    void read_contour(SlcBytes& in, RawLayer& layer, SlcPiece& piece, const Report& report_progress) const {
        const std::size_t at = in.at();
        const auto position = at_byte(at);
        const auto count = in.take<std::uint32_t>("a contour");
        const auto gaps = in.take<std::uint32_t>("a contour");
        if (count > in.left() / point_size)
            in.fail(
                at, fmt::format("a contour of {} points", count),
                fmt::format("{} bytes are left in the file, room for {}", in.left(), in.left() / point_size));
        if (gaps != 0)
            piece.gaps.note(position);
        limits_.make_room(layer.points, count, position);
        for (std::uint32_t i = 0; i < count; ++i) {
            report_progress();
            std::array<float, 2> p{};
            std::memcpy(p.data(), in.data(), sizeof p);
            if (!std::isfinite(p[0]) || !std::isfinite(p[1]))
                in.fail(in.at(), "a point that is not finite", "coordinates must be numbers");
            in.skip(sizeof p);
            layer.points.push_back(
                {static_cast<double>(p[0]) * units_mm_, static_cast<double>(p[1]) * units_mm_});
        }
        const bool returns = layer.returns();
        const bool closed = returns || !open_;
        if (layer.end_contour(closed, 0, limits_, position, piece.dropped) && closed && !returns)
            piece.unclosed.note(position);
    }

    std::string_view bytes_;
    const std::string& name_;
    double units_mm_;
    bool open_;
    ReadLimits& limits_;
    const Executor& executor_;
    ProgressMeter& progress_;
};

class SlcReader {
  public:
    SlcReader(std::string_view bytes, const std::string& name, LayerFile& file, ReadLimits& limits,
              const Execution& execution)
        : bytes_(bytes), name_(name), file_(file), limits_(limits), executor_(execution),
          progress_(execution, Stage::read, bytes.size()) {}

    void read() {
        SlcBytes in = read_header();
        read_pieces(
            pieces_of(bytes_, in.at()), bytes_.size(), executor_,
            [&](std::size_t begin, std::size_t limit) {
                return SlcPieceReader(bytes_, name_, of_layers_, limits_, executor_, progress_)
                    .read(begin, limit);
            },
            [&](SlcPiece&& piece) { all_.append(std::move(piece), limits_); });
        if (!all_.top)
            file_.warnings.emplace_back("the file ends without the mark of its end");
        else if (all_.end != bytes_.size())
            file_.warnings.push_back(
                fmt::format("{} bytes follow the mark of the end, from byte {} on; they were left out",
                            bytes_.size() - all_.end, all_.end));
        if (all_.layers.empty())
            in.fail(all_.end, "no layer", "a slice file must have at least one");
        all_.unclosed.append_to(file_.warnings);
        all_.gaps.append_to(file_.warnings);
        all_.dropped.append_to(file_.warnings);
        place_layers();
        progress_.finish();
    }

  private:
    /// Returns the position of the first layer.
    SlcBytes read_header() {
        const std::string_view header = header_of(bytes_);
        const auto unit = value_of(header, "-unit");
        const std::string name = unit ? lower_case(*unit) : "";
        if (name.starts_with("inch")) {
            file_.units_mm = 25.4;
        } else {
            file_.units_mm = 1;
            if (!name.starts_with("mm"))
                file_.warnings.push_back(unit ? fmt::format("the unit '{}' is unknown; millimetres are taken",
                                                            printable(*unit, 20))
                                              : "the header has no unit; millimetres are taken");
        }
        const std::string type = lower_case(value_of(header, "-type").value_or(""));
        of_layers_ = {file_.units_mm, type.starts_with("web")};
        file_.parts.emplace_back().support = type.starts_with("support");
        SlcBytes in(bytes_, bytes_.find(header_end, header.size()) + 1, name_);
        if (in.left() < reserved)
            in.fail(in.at(), fmt::format("{} bytes", in.left()), "256 reserved bytes must follow the header");
        in.skip(reserved);
        const std::size_t table = in.at();
        const auto entries = in.take<std::uint8_t>("the sampling table");
        if (entries == 0)
            in.fail(table, "a sampling table of no entries", "it must have one at least");
        for (unsigned i = 0; i < entries; ++i) {
            const double z = in.length("the sampling table") * file_.units_mm;
            const double thickness = in.length("the sampling table") * file_.units_mm;
            static_cast<void>(in.length("the sampling table")); // line width compensation
            static_cast<void>(in.take<float>("the sampling table"));
            table_.push_back({z, thickness});
        }
        return in;
    }

    /// Makes the layers. A layer extends to the next one, because the format allows a layer to be omitted if
    /// it equals the one below. The last one extends to the top of the part.
    void place_layers() {
        sort_by_height(all_.layers, file_.warnings);
        add_layers_by_bottoms(
            file_, all_.layers, last_top(), limits_, executor_,
            [bytes = bytes_, &name = name_, layers = of_layers_](std::size_t begin, ReadLimits& limits) {
                const Execution silent{.threads = 1};
                const Executor executor(silent);
                ProgressMeter progress(silent, Stage::read, bytes.size());
                return only_layer(SlcPieceReader(bytes, name, layers, limits, executor, progress)
                                      .read(begin, begin + 1)
                                      .layers);
            });
    }

    double last_top() {
        const double bottom = all_.layers.back().z;
        if (all_.top && *all_.top > bottom)
            return *all_.top;
        double thickness = 0;
        for (const auto& [z, stated] : table_)
            thickness = z <= bottom && stated > 0 ? stated : thickness;
        if (thickness == 0 && all_.layers.size() > 1)
            thickness = bottom - all_.layers[all_.layers.size() - 2].z;
        if (all_.top)
            file_.warnings.push_back(fmt::format("the end of the part is said to be z = {} mm, not above its "
                                                 "last layer; that is taken to be {} mm thick",
                                                 *all_.top, thickness));
        return bottom + thickness;
    }

    struct Sampling {
        double z;
        double thickness;
    };

    std::string_view bytes_;
    const std::string& name_;
    LayerFile& file_;
    ReadLimits& limits_;
    Executor executor_;
    ProgressMeter progress_;
    SlcLayers of_layers_;
    std::vector<Sampling> table_;
    SlcPiece all_;
};

} // namespace

bool is_slc(std::string_view bytes) {
    return lower_case(header_of(bytes)).find("-slcver") != std::string::npos;
}

std::string_view other_slc(std::string_view bytes) {
    if (bytes.starts_with("Slice V"))
        return "an SLC file of Stratasys";
    if (bytes.starts_with("11111"))
        return "a volume of voxels as VTK and VolVis keep them in SLC files";
    return "";
}

LayerFile read_slc(std::string_view bytes, const std::string& name, ReadLimits& limits,
                   const Execution& execution) {
    LayerFile file{.path = name, .format = "slc", .rounding = {.single_precision = true}};
    SlcReader(bytes, name, file, limits, execution).read();
    return file;
}

} // namespace lamella
