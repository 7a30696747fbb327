// The points of all layers are one array, which is written to the file as layers arrive. Hatch lines are
// another array, which waits in a store. The tables of contours are small and are kept in memory until the
// end. An array begins with its shape, so the first bytes of the array of points are written last.

#include "container/byte_store.hpp"
#include "container/inflate.hpp"
#include "container/quoted.hpp"
#include "container/zip_writer.hpp"
#include "slices/engine/layer_writers.hpp"
#include "slices/engine/left_out.hpp"
#include "slices/engine/ordered_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as memory has them");

// Returns the header of an array: magic, version 1.0, the length of the rest, and a Python dictionary. It is
// as long as NumPy's headers, so that the numbers begin at a multiple of 64 bytes.
std::string npy_header(std::string_view type, const std::string& shape, std::size_t size) {
    std::string text = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, shape);
    constexpr std::size_t before = 10;
    text.resize(size - before - 1, ' ');
    text += '\n';
    std::string header("\x93NUMPY\x01\x00", 8);
    header += static_cast<char>(text.size() & 0xFF);
    header += static_cast<char>(text.size() >> 8);
    return header + text;
}

constexpr std::size_t header_size = 128;

template <class T>
std::string_view bytes_in(std::span<const T> values) {
    return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

/// Converts well-formed UTF-8 to the fixed-width characters of NumPy's strings.
std::u32string characters(std::string_view text) {
    std::u32string result;
    for (std::size_t i = 0; i < text.size();) {
        const auto lead = static_cast<unsigned char>(text[i]);
        const std::size_t length = lead < 0x80 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
        char32_t c = length == 1 ? lead : lead & (0x7FU >> length);
        for (std::size_t k = 1; k < length; ++k)
            c = (c << 6U) | (static_cast<unsigned char>(text[i + k]) & 0x3FU);
        result += c;
        i += length;
    }
    return result;
}

/// Size of a contour in the tables: end, layer, part, and a flag for closed ones.
constexpr std::uint64_t bytes_of_contour = 3 * sizeof(std::int64_t) + 1;
constexpr std::uint64_t bytes_of_line = 4 * sizeof(double);
/// Size of a hatch line with its layer and part.
constexpr std::uint64_t bytes_of_hatch = bytes_of_line + 2 * sizeof(std::int64_t);

constexpr Holds npz_holds{.hatches = true, .written_label = printable_label, .labels_mark_vectors = true};

class NpzWriter final : public OrderedWriter {
  public:
    NpzWriter(const std::string& path, const LayerFileInfo& info)
        : OrderedWriter(info, npz_holds), labels_(info.parts), rule_(info.rule),
          zip_(path, Overwriting::yes, info.memory) {
        zip_.begin("points.npy", ZipMethod::stored, header_size);
    }

    std::uint64_t bytes() const noexcept override { return zip_.bytes() + waiting_; }

  private:
    Write formatted(const Plane& plane) override {
        using Part = std::pair<Layer, std::uint32_t>; // a layer with the checksum of its points
        std::vector<Part> layers;
        for (const Layer& layer : plane.polylines)
            layers.emplace_back(layer, crc32_of(bytes_in(layer.points.span())));
        return [this, kept = std::make_shared<const std::vector<Part>>(std::move(layers)),
                all_hatches = plane.hatches](const PlanePosition& place, Completions& after) {
            planes_.push_back(place);
            for (std::size_t part = 0; part < kept->size(); ++part) {
                const auto& [layer, crc] = (*kept)[part];
                const PointArray& hatches = all_hatches[part];
                const std::string_view bytes = bytes_in(layer.points.span());
                zip_.append({bytes, bytes.size(), crc}, kept, after);
                for (std::size_t i = 1; i < layer.offsets.size(); ++i)
                    offsets_.push_back(points_ + static_cast<std::int64_t>(layer.offsets[i]));
                points_ += static_cast<std::int64_t>(layer.points.size());
                const std::uint64_t lines = hatches.size() / 2;
                hatches_.add(bytes_in(hatches.span()));
                waiting_ += layer.contours() * bytes_of_contour + lines * bytes_of_hatch;
                counts_.push_back({layer.contours(), layer.rings, lines});
            }
        };
    }

    void end_file() override {
        waiting_ = 0;
        zip_.end(npy_header("<f8", fmt::format("{}, 2", points_), header_size));
        add_numbers<std::int64_t>("offsets", "<i8", offsets_);
        add_contour_numbers<char>("closed", "|b1", [](const Contour& c) -> char { return c.closed ? 1 : 0; });
        add_contour_numbers<std::int64_t>("layer", "<i8", [](const Contour& c) { return c.layer; });
        add_contour_numbers<std::int64_t>("part", "<i8", [](const Contour& c) { return c.part; });
        add_plane_numbers<std::int64_t>(
            "index", "<i8", [](const PlanePosition& p) { return static_cast<std::int64_t>(p.index); });
        add_plane_numbers<double>("z", "<f8", [](const PlanePosition& p) { return p.z; });
        add_plane_numbers<double>("bottom", "<f8", [](const PlanePosition& p) { return p.bottom; });
        add_plane_numbers<double>("top", "<f8", [](const PlanePosition& p) { return p.top; });
        add_labels();
        if (rule_ != PlaneRule::section_above)
            add_texts("rule", {characters(plane_rule_name(rule_))});
        add_hatches();
        zip_.finish();
    }

    struct PartPlane {
        std::uint64_t contours;
        std::uint64_t rings;
        std::uint64_t hatches;
    };
    struct Contour {
        std::int64_t layer;
        std::int64_t part;
        bool closed;
    };

    /// An array of a known size, written in chunks of some thousand elements.
    class Array {
      public:
        Array(ZipWriter& zip, std::string_view name, std::string_view type, const std::string& shape)
            : zip_(zip) {
            zip_.begin(fmt::format("{}.npy", name), ZipMethod::stored);
            waiting_ = npy_header(type, shape, header_size);
        }

        void add(std::string_view bytes) {
            waiting_ += bytes;
            if (waiting_.size() >= (std::size_t{1} << 18))
                flush();
        }
        void end() {
            flush();
            zip_.end();
        }

      private:
        void flush() {
            zip_.append_stored(waiting_);
            waiting_.clear();
        }

        ZipWriter& zip_;
        std::string waiting_;
    };

    template <class T>
    void add_numbers(std::string_view name, std::string_view type, std::span<const T> values) {
        Array array(zip_, name, type, fmt::format("{},", values.size()));
        array.add(bytes_in(values));
        array.end();
    }

    template <class T, class Value>
    void add_plane_numbers(std::string_view name, std::string_view type, const Value& value) {
        std::vector<T> values;
        for (const PlanePosition& plane : planes_)
            values.push_back(value(plane));
        add_numbers<T>(name, type, values);
    }

    template <class T, class Value>
    void add_contour_numbers(std::string_view name, std::string_view type, const Value& value) {
        const std::size_t contours = offsets_.size() - 1;
        Array array(zip_, name, type, fmt::format("{},", contours));
        for (std::size_t i = 0; i < counts_.size(); ++i) {
            for (std::uint64_t k = 0; k < counts_[i].contours; ++k) {
                const T number = value({layer_of(i), part_of(i), k < counts_[i].rings});
                array.add(bytes_in(std::span(&number, 1)));
            }
        }
        array.end();
    }

    void add_labels() {
        std::vector<std::u32string> labels;
        for (const PartInfo& part : labels_)
            labels.push_back(characters(label_in_file(part, npz_holds)));
        add_texts("labels", std::move(labels));
    }

    void add_texts(std::string_view name, std::vector<std::u32string> texts) {
        std::size_t longest = 1;
        for (const std::u32string& text : texts)
            longest = std::max(longest, text.size());
        const std::string type = fmt::format("<U{}", longest);
        Array array(zip_, name, type, fmt::format("{},", texts.size()));
        for (std::u32string& text : texts) {
            text.resize(longest, U'\0');
            array.add(bytes_in(std::span<const char32_t>(text)));
        }
        array.end();
    }

    // Writes the arrays of hatches if there are any.
    void add_hatches() {
        const std::uint64_t lines = hatches_.size() / bytes_of_line;
        if (lines == 0)
            return;
        Array array(zip_, "hatches", "<f8", fmt::format("{}, 2, 2", lines));
        std::string piece;
        for (std::uint64_t at = 0; at < hatches_.size(); at += piece.size()) {
            piece.resize(std::min<std::uint64_t>(std::size_t{1} << 18, hatches_.size() - at));
            hatches_.read(at, piece);
            array.add(piece);
        }
        array.end();
        add_hatch_numbers("hatch_layer", lines, [this](std::size_t i) { return layer_of(i); });
        add_hatch_numbers("hatch_part", lines, [this](std::size_t i) { return part_of(i); });
    }

    template <class Value>
    void add_hatch_numbers(std::string_view name, std::uint64_t lines, const Value& value) {
        Array array(zip_, name, "<i8", fmt::format("{},", lines));
        for (std::size_t i = 0; i < counts_.size(); ++i) {
            const std::int64_t number = value(i);
            for (std::uint64_t k = 0; k < counts_[i].hatches; ++k)
                array.add(bytes_in(std::span(&number, 1)));
        }
        array.end();
    }

    [[nodiscard]] std::int64_t layer_of(std::size_t count) const {
        return static_cast<std::int64_t>(count / labels_.size());
    }
    [[nodiscard]] std::int64_t part_of(std::size_t count) const {
        return static_cast<std::int64_t>(count % labels_.size());
    }

    std::vector<PartInfo> labels_;
    PlaneRule rule_;
    ZipWriter zip_;
    std::vector<PlanePosition> planes_;
    std::vector<PartPlane> counts_; ///< all parts of the first plane, then of the second ...
    ByteStore hatches_;
    std::vector<std::int64_t> offsets_{0};
    std::int64_t points_ = 0;
    std::uint64_t waiting_ = 0; ///< bytes that contours and hatches will add at the end
};

} // namespace

std::unique_ptr<LayerWriter> open_npz(const std::string& path, const LayerFileInfo& info,
                                      const LayerWriteOptions& /*options*/) {
    return std::make_unique<NpzWriter>(path, info);
}

} // namespace lamella
