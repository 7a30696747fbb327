// The header is text of at most 2048 bytes that ends with 0D 0A 1A, or at least with 1A. 256 reserved bytes,
// the sampling table and the layers follow. A layer consists of the z of its bottom, the number of its
// contours, and the contours. The number 2^32 - 1 ends the file; its z is the top of the part.

#include "lamella/core/error.hpp"

#include "container/text_position.hpp"
#include "container/xml.hpp"
#include "core/executor.hpp"
#include "core/lower_case.hpp"
#include "read/layer_assembly.hpp"
#include "read/layer_readers.hpp"
#include "read/read_limits.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
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

class SlcReader {
  public:
    SlcReader(std::string_view bytes, const std::string& name, LayerFile& file, ReadLimits& limits)
        : bytes_(bytes), name_(name), file_(file), limits_(limits) {}

    void read(const Execution& execution) {
        read_header();
        read_layers(execution);
        if (raw_.empty())
            fail(at_, "no layer", "a slice file must have at least one");
        unclosed_.append_to(file_.warnings);
        gaps_.append_to(file_.warnings);
        dropped_.append_to(file_.warnings);
        place_layers();
    }

  private:
    [[noreturn]] void fail(std::size_t at, const std::string& found, const std::string& expected) const {
        throw Error(ErrorKind::input, fmt::format("{}, byte {}: found {}; {}", name_, at, found, expected));
    }

    [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }

    template <class T>
    T take(const char* what) {
        T value;
        if (left() < sizeof value)
            fail(at_, fmt::format("the end of the file within {}", what), "the file is truncated");
        std::memcpy(&value, bytes_.data() + at_, sizeof value);
        at_ += sizeof value;
        return value;
    }

    double length(const char* what) {
        const std::size_t at = at_;
        const auto value = static_cast<double>(take<float>(what));
        if (!std::isfinite(value))
            fail(at, fmt::format("a number that is not finite in {}", what), "it must be a length");
        return value * file_.units_mm;
    }

    void read_header() {
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
        open_ = type.starts_with("web");
        file_.parts.emplace_back().support = type.starts_with("support");
        at_ = bytes_.find(header_end, header.size()) + 1;
        if (left() < reserved)
            fail(at_, fmt::format("{} bytes", left()), "256 reserved bytes must follow the header");
        at_ += reserved;
        const std::size_t table = at_;
        const auto entries = take<std::uint8_t>("the sampling table");
        if (entries == 0)
            fail(table, "a sampling table of no entries", "it must have one at least");
        for (unsigned i = 0; i < entries; ++i) {
            const double z = length("the sampling table");
            const double thickness = length("the sampling table");
            static_cast<void>(length("the sampling table")); // line width compensation
            static_cast<void>(take<float>("the sampling table"));
            table_.push_back({z, thickness});
        }
    }

    void read_layers(const Execution& execution) {
        Executor executor(execution);
        ProgressMeter progress(execution, Stage::read, bytes_.size());
        std::size_t reported = 0;
        const auto report_progress = [&] {
            if (at_ - reported <= (std::size_t{1} << 22))
                return;
            executor.check_cancelled();
            progress.add(at_ - reported);
            reported = at_;
        };
        for (;;) {
            if (left() == 0) {
                file_.warnings.emplace_back("the file ends without the mark of its end");
                break;
            }
            const std::size_t at = at_;
            const double z = length("a layer");
            const auto contours = take<std::uint32_t>("a layer");
            if (contours == no_more_layers) {
                top_ = z;
                if (left() != 0)
                    file_.warnings.push_back(fmt::format(
                        "{} bytes follow the mark of the end, from byte {} on; they were left out", left(),
                        at_));
                break;
            }
            if (contours > left() / (2 * sizeof(std::uint32_t)))
                fail(at, fmt::format("a layer of {} contours", contours),
                     fmt::format("{} bytes are left in the file", left()));
            limits_.make_room(raw_, 1, at_byte(at));
            RawLayer& layer = raw_.emplace_back();
            layer.z = z;
            layer.location = fmt::format("byte {}", at);
            for (std::uint32_t i = 0; i < contours; ++i)
                read_contour(layer, report_progress);
        }
        progress.finish();
    }

    template <class Report>
    void read_contour(RawLayer& layer, const Report& report_progress) {
        const std::size_t at = at_;
        const auto position = at_byte(at);
        const auto count = take<std::uint32_t>("a contour");
        const auto gaps = take<std::uint32_t>("a contour");
        constexpr std::size_t point_size = 2 * sizeof(float);
        if (count > left() / point_size)
            fail(at, fmt::format("a contour of {} points", count),
                 fmt::format("{} bytes are left in the file, room for {}", left(), left() / point_size));
        if (gaps != 0)
            gaps_.note(position);
        limits_.make_room(layer.points, count, position);
        for (std::uint32_t i = 0; i < count; ++i) {
            report_progress();
            std::array<float, 2> p{};
            std::memcpy(p.data(), bytes_.data() + at_, sizeof p);
            if (!std::isfinite(p[0]) || !std::isfinite(p[1]))
                fail(at_, "a point that is not finite", "coordinates must be numbers");
            at_ += sizeof p;
            layer.points.push_back(
                {static_cast<double>(p[0]) * file_.units_mm, static_cast<double>(p[1]) * file_.units_mm});
        }
        const bool returns = layer.returns();
        const bool closed = returns || !open_;
        if (layer.end_contour(closed, 0, limits_, position, dropped_) && closed && !returns)
            unclosed_.note(position);
    }

    /// Makes the layers. A layer extends to the next one, because the format allows a layer to be omitted if
    /// it equals the one below. The last one extends to the top of the part.
    void place_layers() {
        sort_by_height(raw_, file_.warnings);
        add_layers_by_bottoms(file_, raw_, last_top(), limits_);
    }

    double last_top() {
        const double bottom = raw_.back().z;
        if (top_ && *top_ > bottom)
            return *top_;
        double thickness = 0;
        for (const auto& [z, stated] : table_)
            thickness = z <= bottom && stated > 0 ? stated : thickness;
        if (thickness == 0 && raw_.size() > 1)
            thickness = bottom - raw_[raw_.size() - 2].z;
        if (top_)
            file_.warnings.push_back(fmt::format("the end of the part is said to be z = {} mm, not above its "
                                                 "last layer; that is taken to be {} mm thick",
                                                 *top_, thickness));
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
    std::size_t at_ = 0;
    bool open_ = false; ///< true if contours may be open
    std::vector<Sampling> table_;
    std::vector<RawLayer> raw_;
    std::optional<double> top_;
    UnclosedContours unclosed_;
    CountedWarning gaps_{"contour has gaps, which were taken for lines",
                         "contours have gaps, which were taken for lines"};
    DroppedContours dropped_;
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
    SlcReader(bytes, name, file, limits).read(execution);
    return file;
}

} // namespace lamella
