#include "lamella/core/error.hpp"

#include "container/text_position.hpp"
#include "container/utf8.hpp"
#include "core/executor.hpp"
#include "core/farthest.hpp"
#include "read/layer_assembly.hpp"
#include "read/layer_pieces.hpp"
#include "read/layer_readers.hpp"
#include "read/read_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace lamella {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are read as memory has them");

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

    [[nodiscard]] bool is_single_precision() const { return type_ == "<f4"; }

    /// Returns a length in millimetres. `i` is an index among all numbers of the array.
    [[nodiscard]] double length(std::uint64_t i) const {
        double value = 0;
        if (type_ == "<f8")
            value = at<double>(i);
        else if (type_ == "<f4")
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
        if (type_ == "<i8" || type_ == "<u8")
            value = at<std::uint64_t>(i); // a negative one exceeds any `most`
        else if (type_ == "<i4")
            value = static_cast<std::uint64_t>(std::int64_t{at<std::int32_t>(i)});
        else if (type_ == "<u4")
            value = at<std::uint32_t>(i);
        else if (type_ == "|b1" || type_ == "|u1")
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
    std::vector<std::uint64_t> shape_;
    std::uint64_t element_ = 0;
    std::size_t begin_ = 0;
};

class NpzReader {
  public:
    NpzReader(const ZipReader& zip, LayerFile& file, ReadLimits& limits)
        : zip_(zip), file_(file), limits_(limits) {}

    void read(const Execution& execution) {
        Executor executor(execution);
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

        std::vector<RawLayer> raw;
        limits_.make_room(raw, z.size(), [] { return std::string_view("array 'z'"); });
        raw.resize(z.size());
        for (RawLayer& empty : raw)
            empty.begin = nothing;
        const Contours all{points, offsets, closed, layer, part};
        read_contours(all, raw, executor);
        const std::optional<Hatches> lines = hatches();
        if (lines)
            read_hatches(*lines, all.size(), raw);
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
        add_layers(file_, planes, limits_, executor, layer_again(all, lines, file_.parts.size()));
        for (const Array* lengths : {&points, &z, &bottom, &top})
            if (lengths->is_single_precision())
                file_.rounding.single_precision = true;
        append_to(found_, file_.warnings);
    }

  private:
    /// RawLayer::begin of a layer without contents.
    static constexpr std::size_t nothing = std::numeric_limits<std::size_t>::max();

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

    /// Consecutive contours, as a list of layers for each change of layers.
    struct Piece {
        std::vector<std::pair<std::uint64_t, RawLayer>> layers = {}; ///< with the number of the layer
        Findings found = {};
        std::size_t end = 0; ///< number of the next contour
    };

    /// The arrays that describe contours, which share the memory of the archive.
    struct Contours {
        Array points;
        Array offsets;
        Array closed;
        Array layer;
        Array part;

        [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(offsets.size() - 1); }
        [[nodiscard]] std::uint32_t part_of(std::uint64_t i, std::size_t parts) const {
            return static_cast<std::uint32_t>(part.whole(i, parts - 1));
        }

        /// Adds contour i, which has the points from `begin` to `end`, to its layer.
        void add(std::uint64_t i, std::uint64_t begin, std::uint64_t end, std::uint32_t of_part,
                 RawLayer& into, ReadLimits& limits, Findings& found) const {
            const auto position = [&] {
                return fmt::format("contour {}", i);
            };
            limits.make_room(into.points, end - begin, position);
            for (std::uint64_t k = begin; k < end; ++k)
                into.points.push_back({points.length(2 * k), points.length(2 * k + 1)});
            into.end_contour(closed.whole(i, 1) != 0, of_part, limits, position, found);
        }
    };

    /// The arrays that describe hatch lines.
    struct Hatches {
        Array lines;
        Array layer;
        Array part;

        /// Adds line i to its layer.
        void add(std::uint64_t i, std::size_t parts, RawLayer& into, ReadLimits& limits) const {
            const auto position = [&] {
                return fmt::format("hatch line {}", i);
            };
            limits.make_room(into.hatches, 2, position);
            for (std::uint64_t k = 4 * i; k < 4 * i + 4; k += 2)
                into.hatches.push_back({lines.length(k), lines.length(k + 1)});
            into.end_hatches(static_cast<std::uint32_t>(part.whole(i, parts - 1)), limits, position);
        }
    };

    /// Returns a function that reads consecutive contours of one layer again, from the first one, or hatch
    /// lines, which are numbered behind the contours.
    static ParseLayer layer_again(Contours contours, std::optional<Hatches> hatches, std::size_t parts) {
        return [contours = std::move(contours), hatches = std::move(hatches), parts](std::size_t begin,
                                                                                     ReadLimits& limits) {
            constexpr std::uint64_t any = std::numeric_limits<std::uint64_t>::max();
            RawLayer raw;
            Findings found;
            const auto for_run = [&](const Array& layer, std::uint64_t from, std::uint64_t to,
                                     const auto& add) {
                for (std::uint64_t i = from; i < to && layer.whole(i, any) == layer.whole(from, any); ++i)
                    add(i);
            };
            if (begin < contours.size())
                for_run(contours.layer, begin, contours.size(), [&](std::uint64_t i) {
                    const auto offset = [&](std::uint64_t k) {
                        return contours.offsets.whole(k, contours.points.size());
                    };
                    contours.add(i, offset(i), offset(i + 1), contours.part_of(i, parts), raw, limits, found);
                });
            else if (begin != nothing)
                for_run(hatches->layer, begin - contours.size(), hatches->lines.size(),
                        [&](std::uint64_t i) { hatches->add(i, parts, raw, limits); });
            return raw;
        };
    }

    void read_contours(const Contours& contours, std::vector<RawLayer>& raw, Executor& executor) {
        static_cast<void>(contours.offsets.whole(0, 0));
        read_pieces(
            pieces_of(contours), contours.size(), executor,
            [&](std::size_t begin, std::size_t limit) {
                executor.check_cancelled();
                return read_piece(contours, begin, limit, raw.size());
            },
            [&](Piece&& piece) {
                found_.add(piece.found);
                for (auto& [layer, contents] : piece.layers)
                    put(std::move(contents), raw[layer]);
            });
    }

    /// Returns the contours with which pieces begin: where the layer changes, as far as the arrays are sound.
    static PieceBegins pieces_of(const Contours& contours) {
        constexpr std::uint64_t points_of_piece = layer_piece_bytes / sizeof(Point2);
        PieceBegins begins{0};
        try {
            std::uint64_t from = 0;
            for (std::size_t i = 1; i < contours.size(); ++i) {
                const std::uint64_t offset = contours.offsets.whole(i, contours.points.size());
                if (offset - from < points_of_piece || offset < from)
                    continue;
                constexpr std::uint64_t any = std::numeric_limits<std::uint64_t>::max();
                if (contours.layer.whole(i, any) == contours.layer.whole(i - 1, any))
                    continue;
                begins.push_back(i);
                from = offset;
            }
        } catch (const Error&) { // reading the contours reports it
        }
        return begins;
    }

    Piece read_piece(const Contours& contours, std::size_t from, std::size_t to, std::size_t layers) const {
        const Array& points = contours.points;
        Piece piece;
        std::uint64_t begin = contours.offsets.whole(from, points.size());
        for (std::uint64_t i = from; i < to; ++i) {
            const std::uint64_t end = contours.offsets.whole(i + 1, points.size());
            if (end < begin)
                contours.offsets.fail(fmt::format("{} behind {}", end, begin), "they must not descend");
            const std::uint64_t layer = contours.layer.whole(i, layers - 1);
            const std::uint32_t part = contours.part_of(i, file_.parts.size());
            const auto position = [&] {
                return fmt::format("contour {}", i);
            };
            if (piece.layers.empty() || piece.layers.back().first != layer) {
                limits_.make_room(piece.layers, 1, position);
                if (!piece.layers.empty())
                    piece.layers.back().second.end_layer(limits_);
                piece.layers.emplace_back(layer, RawLayer()).second.begin = static_cast<std::size_t>(i);
            }
            contours.add(i, begin, end, part, piece.layers.back().second, limits_, piece.found);
            begin = end;
        }
        if (!piece.layers.empty())
            piece.layers.back().second.end_layer(limits_);
        piece.end = to;
        return piece;
    }

    /// Adds contents to a layer, which may come more than once.
    void put(RawLayer&& contents, RawLayer& into) const {
        if (into.begin == nothing)
            into = std::move(contents);
        else
            append(into, contents);
    }

    void append(RawLayer& into, const RawLayer& more) const {
        const auto location = [] {
            return std::string_view("array 'layer'");
        };
        limits_.make_room(into.points, more.points.size(), location);
        limits_.make_room(into.ends, more.ends.size(), location);
        limits_.make_room(into.hatches, more.hatches.size(), location);
        limits_.make_room(into.hatch_ends, more.hatch_ends.size(), location);
        into.append(more);
        limits_.give_back(0, (more.points.capacity() + more.hatches.capacity()) * sizeof(Point2) +
                                 more.ends.capacity() * sizeof(RawLayer::Contour) +
                                 more.hatch_ends.capacity() * sizeof(RawLayer::Hatches));
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

    [[nodiscard]] std::optional<Hatches> hatches() const {
        if (zip_.find("hatches.npy") == nullptr)
            return std::nullopt;
        const Array lines = array("hatches");
        lines.expect_shape({2, 2}, "hatch lines have two points");
        return Hatches{lines, list("hatch_layer", lines.size(), "hatch lines"),
                       list("hatch_part", lines.size(), "hatch lines")};
    }

    void read_hatches(const Hatches& hatches, std::size_t contours, std::vector<RawLayer>& raw) const {
        RawLayer run;
        std::uint64_t of_layer = 0;
        const auto end_run = [&] {
            if (run.hatches.empty())
                return;
            run.end_layer(limits_);
            put(std::exchange(run, RawLayer()), raw[of_layer]);
        };
        for (std::uint64_t i = 0; i < hatches.lines.size(); ++i) {
            const std::uint64_t layer = hatches.layer.whole(i, raw.size() - 1);
            if (layer != of_layer)
                end_run();
            of_layer = layer;
            if (run.hatches.empty())
                run.begin = static_cast<std::size_t>(contours + i);
            hatches.add(i, file_.parts.size(), run, limits_);
        }
        end_run();
        if (hatches.lines.is_single_precision())
            file_.rounding.single_precision = true;
    }

    const ZipReader& zip_;
    LayerFile& file_;
    ReadLimits& limits_;
    Findings found_;
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
