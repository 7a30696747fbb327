// The header is text of at most 2048 bytes that ends with 0D 0A 1A, or at least with 1A. 256 reserved bytes,
// the sampling table and the layers follow. A layer consists of the z of its bottom, the number of its
// contours, and the contours. The number 2^32 - 1 ends the file; its z is the top of the part.

#include "lamella/core/error.hpp"

#include "container/text_position.hpp"
#include "container/xml.hpp"
#include "core/executor.hpp"
#include "core/lower_case.hpp"
#include "slices/engine/layer_readers.hpp"
#include "slices/engine/slice_engine.hpp"
#include "slices/formats/slc_format.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace lamella {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are read as memory has them");

constexpr std::size_t longest_header = 2048;
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
        if (contours == slc::no_more_layers)
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
    Findings found = {};
    std::size_t end = 0;
    std::optional<double> top = {}; ///< of the part, if the piece has the mark of the end
};

class SlcFile {
  public:
    using Piece = SlcPiece;

    /// Reads the header.
    SlcFile(std::string_view bytes, const std::string& name, LayerFile& file) : bytes_(bytes), name_(name) {
        const std::string_view header = header_of(bytes_);
        const auto unit = value_of(header, "-unit");
        const std::string unit_name = unit ? lower_case(*unit) : "";
        units_mm_ = unit_name.starts_with("inch") ? 25.4 : 1;
        if (units_mm_ == 1 && !unit_name.starts_with("mm"))
            file.warnings.push_back(
                unit ? fmt::format("the unit '{}' is unknown; millimetres are taken", printable(*unit, 20))
                     : "the header has no unit; millimetres are taken");
        const std::string type = lower_case(value_of(header, "-type").value_or(""));
        open_ = type.starts_with("web");
        file.units_mm = units_mm_;
        file.parts.push_back({.label = {}, .support = type.starts_with("support")});
        read_table(bytes_.find(header_end, header.size()) + 1);
    }

    [[nodiscard]] PieceBegins begins(Executor& /*executor*/) const { return pieces_of(bytes_, first_); }
    [[nodiscard]] std::size_t end() const { return bytes_.size(); }

    /// Reads layers up to `limit`, or the mark of the end.
    [[nodiscard]] SlcPiece parse(std::size_t begin, std::size_t limit, const Reading& reading) const {
        SlcBytes in(bytes_, begin, name_);
        SlcPiece piece;
        ReadPosition position(reading, begin);
        while (in.at() < limit) {
            const std::size_t at = in.at();
            const double z = in.length("a layer") * units_mm_;
            const auto contours = in.take<std::uint32_t>("a layer");
            if (contours == slc::no_more_layers) {
                piece.top = z;
                break;
            }
            if (contours > in.left() / (2 * sizeof(std::uint32_t)))
                in.fail(at, fmt::format("a layer of {} contours", contours),
                        fmt::format("{} bytes are left in the file", in.left()));
            reading.limits.make_room(piece.layers, 1, at_byte(at));
            RawLayer& layer = piece.layers.emplace_back();
            layer.z = z;
            layer.location = fmt::format("byte {}", at);
            layer.begin = at;
            for (std::uint32_t i = 0; i < contours; ++i) {
                position.reached(in.at());
                read_contour(in, layer, piece, reading.limits);
            }
        }
        piece.end = in.at();
        position.end(piece.end);
        return piece;
    }
    [[nodiscard]] static RawLayer layer(SlcPiece&& piece) { return only_layer(std::move(piece.layers)); }

    void append(SlcPiece&& piece, ReadLimits& limits) {
        append_layers(all_.layers, std::move(piece.layers), limits);
        all_.found.add(piece.found);
        all_.end = piece.end;
        all_.top = piece.top;
    }

    /// Returns the layers, and warns of irregularities. A layer extends to the next one, because the format
    /// allows a layer to be omitted if it equals the one below. The last one extends to `top`.
    [[nodiscard]] std::vector<RawLayer> take_layers(std::vector<std::string>& warnings, double& top) {
        if (!all_.top)
            warnings.emplace_back("the file ends without the mark of its end");
        else if (all_.end != bytes_.size())
            warnings.push_back(
                fmt::format("{} bytes follow the mark of the end, from byte {} on; they were left out",
                            bytes_.size() - all_.end, all_.end));
        if (all_.layers.empty())
            SlcBytes(bytes_, all_.end, name_)
                .fail(all_.end, "no layer", "a slice file must have at least one");
        append_to(all_.found, warnings);
        sort_by_height(all_.layers, warnings);
        top = last_top(warnings);
        return std::move(all_.layers);
    }

  private:
    /// Reads the sampling table, which follows 256 reserved bytes behind the header.
    void read_table(std::size_t begin) {
        SlcBytes in(bytes_, begin, name_);
        if (in.left() < slc::reserved)
            in.fail(in.at(), fmt::format("{} bytes", in.left()), "256 reserved bytes must follow the header");
        in.skip(slc::reserved);
        const std::size_t table = in.at();
        const auto entries = in.take<std::uint8_t>("the sampling table");
        if (entries == 0)
            in.fail(table, "a sampling table of no entries", "it must have one at least");
        for (unsigned i = 0; i < entries; ++i) {
            const double z = in.length("the sampling table") * units_mm_;
            const double thickness = in.length("the sampling table") * units_mm_;
            static_cast<void>(in.length("the sampling table")); // line width compensation
            static_cast<void>(in.take<float>("the sampling table"));
            table_.push_back({z, thickness});
        }
        first_ = in.at();
    }

    void read_contour(SlcBytes& in, RawLayer& layer, SlcPiece& piece, ReadLimits& limits) const {
        const std::size_t at = in.at();
        const auto position = at_byte(at);
        const auto count = in.take<std::uint32_t>("a contour");
        const auto gaps = in.take<std::uint32_t>("a contour");
        if (count > in.left() / point_size)
            in.fail(
                at, fmt::format("a contour of {} points", count),
                fmt::format("{} bytes are left in the file, room for {}", in.left(), in.left() / point_size));
        if (gaps != 0)
            piece.found.note(FindingKind::contours_with_gaps, position);
        limits.make_room(layer.points, count, position);
        for (std::uint32_t i = 0; i < count; ++i) {
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
        if (layer.end_contour(closed, 0, limits, position, piece.found) && closed && !returns)
            piece.found.note(FindingKind::unclosed_rings, position);
    }

    [[nodiscard]] double last_top(std::vector<std::string>& warnings) const {
        const double bottom = all_.layers.back().z;
        if (all_.top && *all_.top > bottom)
            return *all_.top;
        double thickness = 0;
        for (const auto& [z, stated] : table_)
            thickness = z <= bottom && stated > 0 ? stated : thickness;
        if (thickness == 0 && all_.layers.size() > 1)
            thickness = bottom - all_.layers[all_.layers.size() - 2].z;
        if (all_.top)
            warnings.push_back(fmt::format("the end of the part is said to be z = {} mm, not above its "
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
    double units_mm_ = 1;
    bool open_ = false;     ///< true if contours may be open
    std::size_t first_ = 0; ///< offset of the first layer
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
    LayerFile file = layer_file(name, "slc");
    file.rounding.single_precision = true;
    const auto slc = std::make_shared<SlcFile>(bytes, name, file);
    read_layers_of(*slc, limits, execution, bytes.size());
    double top = 0;
    std::vector<RawLayer> layers = slc->take_layers(file.warnings, top);
    add_layers_by_bottoms(file, layers, top, limits, execution, parsing_again<SlcFile>(slc));
    return file;
}

} // namespace lamella
