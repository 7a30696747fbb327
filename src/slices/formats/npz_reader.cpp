#include "lamella/core/error.hpp"

#include "container/text_position.hpp"
#include "container/utf8.hpp"
#include "core/executor.hpp"
#include "core/farthest.hpp"
#include "slices/engine/layer_readers.hpp"
#include "slices/engine/slice_engine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace lamella {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are read as memory has them");

enum class NumpyType : std::uint8_t { f4, f8, i4, i8, u4, u8, byte, other };

NumpyType numpy_type(std::string_view text) {
    return text == "<f8"                    ? NumpyType::f8
           : text == "<f4"                  ? NumpyType::f4
           : text == "<i8"                  ? NumpyType::i8
           : text == "<u8"                  ? NumpyType::u8
           : text == "<i4"                  ? NumpyType::i4
           : text == "<u4"                  ? NumpyType::u4
           : text == "|b1" || text == "|u1" ? NumpyType::byte
                                            : NumpyType::other;
}

/// One array of the archive.
class Array {
  public:
    explicit Array(ByteSource source) : source_(std::move(source)) {
        bytes_ = source_.text();
        read_header();
    }

    [[nodiscard]] std::uint64_t size() const { return shape_.front(); }

    [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
        throw Error(ErrorKind::input, fmt::format("{}: found {}; {}", source_.name, found, expected));
    }

    void expect_shape(const std::vector<std::uint64_t>& rest, const char* what) const {
        if (!std::equal(shape_.begin() + 1, shape_.end(), rest.begin(), rest.end()))
            fail("an array of another shape", what);
    }

    [[nodiscard]] bool is_single_precision() const { return numbers_ == NumpyType::f4; }

    /// Returns a length in millimetres. `i` is an index among all numbers of the array.
    [[nodiscard]] double length(std::uint64_t i) const {
        double value = 0;
        if (numbers_ == NumpyType::f8)
            value = at<double>(i);
        else if (numbers_ == NumpyType::f4)
            value = at<float>(i);
        else
            fail(fmt::format("numbers of type '{}'", excerpt(type_)), "lengths are '<f8' or '<f4'");
        if (is_too_far(value))
            fail(fmt::format("the number {}", value),
                 fmt::format("lengths must lie within {} mm", farthest_mm));
        return value + 0.0;
    }

    /// Returns an integer between 0 and `most`.
    [[nodiscard]] std::uint64_t whole(std::uint64_t i, std::uint64_t most) const {
        std::uint64_t value = 0;
        if (numbers_ == NumpyType::i8 || numbers_ == NumpyType::u8)
            value = at<std::uint64_t>(i); // a negative one exceeds any `most`
        else if (numbers_ == NumpyType::i4)
            value = static_cast<std::uint64_t>(std::int64_t{at<std::int32_t>(i)});
        else if (numbers_ == NumpyType::u4)
            value = at<std::uint32_t>(i);
        else if (numbers_ == NumpyType::byte)
            value = at<std::uint8_t>(i);
        else
            fail(fmt::format("numbers of type '{}'", excerpt(type_)),
                 "whole numbers are '<i8', '<u8', '<i4' or '<u4'");
        if (value > most)
            fail(fmt::format("{} at place {}", static_cast<std::int64_t>(value), i),
                 fmt::format("it must lie between 0 and {}", most));
        return value;
    }

    /// Returns a string of fixed width as UTF-8, without the zeros at its end.
    [[nodiscard]] std::string text(std::uint64_t i) const {
        if (!type_.starts_with("<U"))
            fail(fmt::format("elements of type '{}'", excerpt(type_)), "strings are '<U...'");
        const std::uint64_t width = element_ / sizeof(char32_t);
        std::string result;
        for (std::uint64_t k = 0; k < width; ++k) {
            const auto c = at<std::uint32_t>(i * width + k);
            if (c == 0)
                break;
            if (c > 0x10FFFF || (c >= 0xD800 && c < 0xE000))
                fail(fmt::format("the character number {}", c), "there is none");
            append_utf8(result, c);
        }
        return result;
    }

  private:
    template <class T>
    [[nodiscard]] T at(std::uint64_t i) const {
        T value;
        std::memcpy(&value, bytes_.data() + begin_ + i * sizeof(T), sizeof value);
        return value;
    }

    // The header: "\x93NUMPY", a version, the length of the dictionary (16 bits in version 1, then 32), the
    // dictionary.
    void read_header() {
        constexpr std::string_view magic = "\x93NUMPY";
        if (!bytes_.starts_with(magic) || bytes_.size() < 12)
            fail("no NumPy array", "it must begin with \\x93NUMPY");
        const bool old = bytes_[magic.size()] == 1;
        const std::size_t text_begin = old ? 10 : 12;
        std::uint64_t length = 0;
        std::memcpy(&length, bytes_.data() + magic.size() + 2, old ? 2 : 4);
        if (length > bytes_.size() - text_begin)
            fail(fmt::format("a header of {} bytes", length), fmt::format("the array has {}", bytes_.size()));
        const std::string_view dictionary = bytes_.substr(text_begin, length);
        begin_ = text_begin + length;
        type_ = std::string(quoted(dictionary, "descr"));
        numbers_ = numpy_type(type_);
        read_shape(dictionary);
        if (value(dictionary, "fortran_order").starts_with("True") && shape_.size() > 1)
            fail("an array in Fortran's order", "the last index must run fastest");
        element_ = element_size();
        // If elements could be empty, the first number of the shape could claim any number of them.
        if (std::find(shape_.begin() + 1, shape_.end(), 0U) != shape_.end())
            fail("a shape with a 0 behind its first number", "elements must not be empty");
        std::uint64_t numbers = 1;
        for (const std::uint64_t n : shape_) {
            if (n != 0 && numbers > std::numeric_limits<std::uint64_t>::max() / n / element_)
                fail("an array of absurd shape", fmt::format("it has {} bytes", bytes_.size()));
            numbers *= n;
        }
        if (numbers > (bytes_.size() - begin_) / element_)
            fail(fmt::format("a shape of {} elements", numbers),
                 fmt::format("{} bytes follow, room for {}", bytes_.size() - begin_,
                             (bytes_.size() - begin_) / element_));
    }

    [[nodiscard]] std::string_view value(std::string_view dictionary, std::string_view key) const {
        std::size_t at = dictionary.find(fmt::format("'{}'", key));
        at = at == std::string_view::npos ? at : dictionary.find(':', at);
        at = at == std::string_view::npos ? at : dictionary.find_first_not_of(' ', at + 1);
        if (at == std::string_view::npos)
            fail(fmt::format("a header without '{}'", key), "NumPy writes it");
        return dictionary.substr(at);
    }

    [[nodiscard]] std::string_view quoted(std::string_view dictionary, std::string_view key) const {
        const std::string_view text = value(dictionary, key);
        const std::size_t end = text.find('\'', 1);
        if (text.front() != '\'' || end == std::string_view::npos)
            fail(fmt::format("'{}'", printable(text, 20)), "a type must be a string");
        return text.substr(1, end - 1);
    }

    void read_shape(std::string_view dictionary) {
        std::string_view text = value(dictionary, "shape");
        const std::size_t end = text.find(')');
        if (text.front() != '(' || end == std::string_view::npos)
            fail(fmt::format("'{}'", printable(text, 20)), "a shape must be a tuple");
        text = text.substr(1, end - 1);
        for (;;) {
            text.remove_prefix(std::min(text.find_first_not_of(", "), text.size()));
            if (text.empty())
                break;
            std::uint64_t n = 0;
            const auto [to, error] = std::from_chars(text.data(), text.data() + text.size(), n);
            if (error != std::errc())
                fail(fmt::format("'{}' in a shape", printable(text, 20)), "it must be a whole number");
            shape_.push_back(n);
            text.remove_prefix(static_cast<std::size_t>(to - text.data()));
        }
        if (shape_.empty())
            fail("a single number", "an array is expected");
    }

    [[nodiscard]] std::uint64_t element_size() const {
        std::uint64_t digits = 0;
        constexpr std::uint64_t most = 1U << 20;
        if (type_.size() > 2)
            std::from_chars(type_.data() + 2, type_.data() + type_.size(), digits);
        if (digits == 0 || digits > most)
            fail(fmt::format("elements of type '{}'", printable(type_, 20)), "they must have a size");
        return type_[1] == 'U' ? digits * sizeof(char32_t) : digits;
    }

    ByteSource source_;
    std::string_view bytes_;
    std::string type_;
    NumpyType numbers_ = NumpyType::other; ///< the type, which each number asks for
    std::vector<std::uint64_t> shape_;
    std::uint64_t element_ = 0;
    std::size_t begin_ = 0;
};

/// The arrays that describe contours, which share the memory of the archive.
struct NpzContours {
    Array points;
    Array offsets;
    Array closed;
    Array layer;
    Array part;
};

/// The arrays that describe hatch lines.
struct NpzHatches {
    Array lines;
    Array layer;
    Array part;
};

struct NumberedLayer : RawLayer {
    std::uint64_t number = 0;
};

/// The contours and, numbered behind them, the hatch lines. They need not be in the order of their layers:
/// in a piece, each run of contours or of hatch lines of one layer is a layer.
class NpzVectors {
  public:
    struct Piece {
        std::vector<NumberedLayer> layers = {};
        Findings found = {};
        std::size_t end = 0; ///< number of the next contour or hatch line
    };

    NpzVectors(NpzContours contours, std::optional<NpzHatches> hatches, std::uint64_t layers,
               std::uint64_t parts, ReadLimits& limits)
        : contours_(std::move(contours)), hatches_(std::move(hatches)),
          first_hatch_(static_cast<std::size_t>(contours_.offsets.size() - 1)), layers_(layers),
          parts_(parts) {
        limits.make_room(all_, layers, [] { return std::string_view("array 'z'"); });
        all_.resize(layers);
        for (RawLayer& empty : all_)
            empty.begin = nothing;
        static_cast<void>(contours_.offsets.whole(0, 0));
    }

    /// Returns the size of the vectors in memory.
    [[nodiscard]] std::uint64_t bytes() const {
        return (contours_.points.size() + 2 * (end() - first_hatch_)) * sizeof(Point2);
    }

    /// Divides the vectors where the layer changes, as far as the arrays are sound.
    [[nodiscard]] PieceBegins begins(Executor& /*executor*/) const {
        PieceBegins begins{0};
        try {
            std::uint64_t points = 0; // of the last piece
            for (std::size_t i = 1; i < end(); ++i) {
                points += i <= first_hatch_ ? offset(i) - offset(i - 1) : 2;
                if (points < layer_piece_bytes / sizeof(Point2) || !begins_run(i))
                    continue;
                begins.push_back(i);
                points = 0;
            }
        } catch (const Error&) { // reading the contours reports it
        }
        return begins;
    }
    [[nodiscard]] std::size_t end() const {
        return first_hatch_ + (hatches_ ? static_cast<std::size_t>(hatches_->lines.size()) : 0);
    }

    [[nodiscard]] Piece parse(std::size_t begin, std::size_t limit, const Reading& reading) const {
        reading.executor.check_cancelled();
        Piece piece;
        piece.end = begin;
        for (std::size_t& i = piece.end; i < limit || (i < end() && !begins_run(i)); ++i)
            if (i < first_hatch_)
                add_contour(i, piece, reading);
            else
                add_hatch(i, piece, reading);
        for (const RawLayer& layer : piece.layers)
            reading.progress.add((layer.points.size() + layer.hatches.size()) * sizeof(Point2));
        return piece;
    }
    [[nodiscard]] static RawLayer layer(Piece&& piece) {
        return piece.layers.empty() ? RawLayer() : only_layer(std::move(piece.layers));
    }

    void append(Piece&& piece, ReadLimits& limits) {
        found_.add(piece.found);
        for (NumberedLayer& layer : piece.layers)
            if (RawLayer& into = all_[layer.number]; into.begin == nothing)
                into = std::move(layer);
            else
                append(layer, into, limits);
    }

    [[nodiscard]] std::vector<RawLayer>& layers() { return all_; }
    [[nodiscard]] const Findings& found() const { return found_; }

  private:
    /// RawLayer::begin of a layer without contents.
    static constexpr std::size_t nothing = std::numeric_limits<std::size_t>::max();

    [[nodiscard]] std::uint64_t offset(std::size_t contour) const {
        return contours_.offsets.whole(contour, contours_.points.size());
    }

    /// Returns whether vector `i` begins a run, unless it is the first one.
    [[nodiscard]] bool begins_run(std::size_t i) const {
        const bool hatch = i >= first_hatch_;
        const Array& layer = hatch ? hatches_->layer : contours_.layer;
        const std::size_t k = hatch ? i - first_hatch_ : i;
        constexpr std::uint64_t any = std::numeric_limits<std::uint64_t>::max();
        return i == first_hatch_ || layer.whole(k, any) != layer.whole(k - 1, any);
    }

    /// Returns the layer of vector `i`, which has this number.
    template <class Location>
    RawLayer& run_of(std::size_t i, std::uint64_t number, Piece& piece, ReadLimits& limits,
                     const Location& location) const {
        if (piece.layers.empty() || piece.layers.back().number != number || i == first_hatch_) {
            limits.make_room(piece.layers, 1, location);
            piece.layers.emplace_back().number = number;
            piece.layers.back().begin = i;
        }
        return piece.layers.back();
    }

    void add_contour(std::size_t i, Piece& piece, const Reading& reading) const {
        const std::uint64_t begin = offset(i);
        const std::uint64_t end = offset(i + 1);
        if (end < begin)
            contours_.offsets.fail(fmt::format("{} behind {}", end, begin), "they must not descend");
        const auto position = [&] {
            return fmt::format("contour {}", i);
        };
        const std::uint64_t number = contours_.layer.whole(i, layers_ - 1);
        const auto part = static_cast<std::uint32_t>(contours_.part.whole(i, parts_ - 1));
        RawLayer& into = run_of(i, number, piece, reading.limits, position);
        reading.limits.make_room(into.points, end - begin, position);
        for (std::uint64_t k = begin; k < end; ++k)
            into.points.push_back({contours_.points.length(2 * k), contours_.points.length(2 * k + 1)});
        into.end_contour(contours_.closed.whole(i, 1) != 0, part, reading.limits, position, piece.found);
    }

    void add_hatch(std::size_t i, Piece& piece, const Reading& reading) const {
        const std::uint64_t k = i - first_hatch_;
        const auto position = [&] {
            return fmt::format("hatch line {}", k);
        };
        RawLayer& into = run_of(i, hatches_->layer.whole(k, layers_ - 1), piece, reading.limits, position);
        reading.limits.make_room(into.hatches, 2, position);
        for (const std::uint64_t at : {4 * k, 4 * k + 2})
            into.hatches.push_back({hatches_->lines.length(at), hatches_->lines.length(at + 1)});
        into.end_hatches(static_cast<std::uint32_t>(hatches_->part.whole(k, parts_ - 1)), reading.limits,
                         position);
    }

    static void append(const RawLayer& more, RawLayer& into, ReadLimits& limits) {
        const auto location = [] {
            return std::string_view("array 'layer'");
        };
        limits.make_room(into.points, more.points.size(), location);
        limits.make_room(into.ends, more.ends.size(), location);
        limits.make_room(into.hatches, more.hatches.size(), location);
        limits.make_room(into.hatch_ends, more.hatch_ends.size(), location);
        into.append(more);
        limits.give_back(0, (more.points.capacity() + more.hatches.capacity()) * sizeof(Point2) +
                                more.ends.capacity() * sizeof(RawLayer::Contour) +
                                more.hatch_ends.capacity() * sizeof(RawLayer::Hatches));
    }

    NpzContours contours_;
    std::optional<NpzHatches> hatches_;
    std::size_t first_hatch_; ///< its number
    std::uint64_t layers_;
    std::uint64_t parts_;
    std::vector<RawLayer> all_;
    Findings found_;
};

class NpzReader {
  public:
    NpzReader(const ZipReader& zip, LayerFile& file, ReadLimits& limits)
        : zip_(zip), file_(file), limits_(limits) {}

    void read(const Execution& execution) {
        const Array points = array("points");
        points.expect_shape({2}, "points have two coordinates");
        const Array offsets = list("offsets");
        if (offsets.size() == 0)
            offsets.fail("no element", "there must be one more than contours");
        const std::uint64_t contours = offsets.size() - 1;
        const Array closed = list("closed", contours, "contours");
        const Array layer = list("layer", contours, "contours");
        const Array part = list("part", contours, "contours");
        const Array z = list("z");
        if (z.size() == 0)
            z.fail("no layer", "a slice file must have at least one");
        const Array bottom = list("bottom", z.size(), "layers");
        const Array top = list("top", z.size(), "layers");
        const Array index = list("index", z.size(), "layers");
        const Array labels = list("labels");
        if (labels.size() == 0)
            labels.fail("no part", "there must be one");
        constexpr std::uint64_t most_parts = std::numeric_limits<std::uint32_t>::max();
        if (labels.size() > most_parts || labels.size() > zip_.unpacked() + 1)
            labels.fail(fmt::format("{} parts", labels.size()), "this many are not possible");
        limits_.make_room(file_.parts, labels.size(), [] { return std::string_view("array 'labels'"); });
        ReadLabels read_labels;
        for (std::uint64_t i = 0; i < labels.size(); ++i) {
            const std::string label = read_labels.of(labels.text(i));
            file_.parts.push_back({.label = label, .box = {}, .exposure = labelled_exposure(label)});
        }
        read_labels.append_to(file_.warnings);
        check_part_planes(file_, z.size(), zip_.unpacked());
        read_rule();
        const std::optional<NpzHatches> lines = hatches();
        const auto vectors = std::make_shared<NpzVectors>(NpzContours{points, offsets, closed, layer, part},
                                                          lines, z.size(), labels.size(), limits_);
        read_layers_of(*vectors, limits_, execution, vectors->bytes());
        std::vector<RawLayer> raw = std::move(vectors->layers());
        constexpr std::uint64_t most_index = 9'000'000'000'000'000;
        std::vector<PlacedLayer> planes;
        planes.reserve(raw.size());
        for (std::uint64_t i = 0; i < raw.size(); ++i) {
            const double at = z.length(i);
            const double from = bottom.length(i);
            const double to = top.length(i);
            if (!(from <= at && at <= to))
                z.fail(fmt::format("z = {} outside of its layer from {} to {}", at, from, to),
                       "z must lie between bottom and top");
            if (i > 0 && !(z.length(i - 1) < at))
                z.fail(fmt::format("z = {} behind z = {}", at, z.length(i - 1)), "layers must ascend");
            planes.push_back({&raw[i], index.whole(i, most_index), at, from, to});
        }
        add_layers(file_, planes, limits_, execution, parsing_again<NpzVectors>(vectors));
        for (const Array* lengths : {&points, &z, &bottom, &top, lines ? &lines->lines : &points})
            if (lengths->is_single_precision())
                file_.rounding.single_precision = true;
        append_to(vectors->found(), file_.warnings);
    }

  private:
    [[nodiscard]] Array array(const std::string& name) const {
        const ZipEntry* entry = zip_.find(name + ".npy");
        if (entry == nullptr)
            throw Error(ErrorKind::input,
                        fmt::format("{}: found no array '{}'; the arrays of layers are points, offsets, "
                                    "closed, layer, part, index, z, bottom, top and labels",
                                    zip_.name(), name));
        return Array(unpacked_entry(zip_, *entry, limits_));
    }
    /// Returns an array of one dimension.
    [[nodiscard]] Array list(const std::string& name) const {
        Array result = array(name);
        result.expect_shape({}, "it must be a list");
        return result;
    }
    /// Returns an array with one element for each of `of`.
    [[nodiscard]] Array list(const std::string& name, std::uint64_t size, std::string_view of) const {
        Array result = list(name);
        if (size != result.size())
            result.fail(fmt::format("{} elements", result.size()), fmt::format("there are {} {}", size, of));
        return result;
    }

    void read_rule() const {
        if (zip_.find("rule.npy") == nullptr)
            return;
        const Array array = list("rule", 1, "rule");
        const std::string name = array.text(0);
        const std::optional<PlaneRule> rule = plane_rule(name);
        if (!rule)
            array.fail(fmt::format("'{}'", printable(name, 40)),
                       "planes are cut by section_above or section_below");
        file_.rule = *rule;
    }

    [[nodiscard]] std::optional<NpzHatches> hatches() const {
        if (zip_.find("hatches.npy") == nullptr)
            return std::nullopt;
        const Array lines = array("hatches");
        lines.expect_shape({2, 2}, "hatch lines have two points");
        return NpzHatches{lines, list("hatch_layer", lines.size(), "hatch lines"),
                          list("hatch_part", lines.size(), "hatch lines")};
    }

    const ZipReader& zip_;
    LayerFile& file_;
    ReadLimits& limits_;
};

} // namespace

bool is_npz(const ZipReader& zip) {
    return zip.find("points.npy") != nullptr;
}

LayerFile read_npz(const ZipReader& zip, ReadLimits& limits, const Execution& execution) {
    LayerFile file = layer_file(zip.name(), "npz", 1);
    file.warnings = zip.counted_warnings();
    NpzReader(zip, file, limits).read(execution);
    return file;
}

} // namespace lamella
