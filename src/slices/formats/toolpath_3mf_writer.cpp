// The package has one part for each layer, then the model, which contains the profiles and the list of
// layers. Layers refer to the parts on the plate and to the profiles by identifiers derived from the header
// of the file.

#include "lamella/contour/measure.hpp"
#include "lamella/core/error.hpp"

#include "container/byte_buffer.hpp"
#include "container/decimal.hpp"
#include "container/quoted.hpp"
#include "slices/engine/exposure_keys.hpp"
#include "slices/engine/grid.hpp"
#include "slices/engine/layer_writers.hpp"
#include "slices/engine/written_heights.hpp"
#include "slices/formats/package_3mf.hpp"
#include "slices/formats/toolpath_3mf_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <set>
#include <vector>

namespace lamella {

namespace {

constexpr std::string_view xml_begin = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
constexpr std::int64_t most_coordinate = std::numeric_limits<std::int32_t>::max();

/// Returns a hash of a text (FNV-1a) from a given start value.
std::uint64_t hash_of(std::string_view text, std::uint64_t start) {
    std::uint64_t hash = start;
    for (const char c : text)
        hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3;
    return hash;
}

/// Returns a UUID of version 8 (custom). Equal texts have equal identifiers.
std::string uuid_of(std::string_view text) {
    std::uint64_t high = hash_of(text, 0xCBF29CE484222325);
    std::uint64_t low = hash_of(text, high);
    high = (high & ~std::uint64_t{0xF000}) | 0x8000;
    low = (low & ~(std::uint64_t{3} << 62U)) | std::uint64_t{2} << 62U;
    return fmt::format("{:08x}-{:04x}-{:04x}-{:04x}-{:012x}", high >> 32U, high >> 16U & 0xFFFFU,
                       high & 0xFFFFU, low >> 48U, low & 0xFFFFFFFFFFFFU);
}

std::string attribute(std::string_view name, double value) {
    return fmt::format(" {}=\"{}\"", name, exact_decimal_text(value));
}

/// Returns an attribute, or "" for a speed or length of 0, which means unknown and is not allowed in the
/// file.
std::string positive_attribute(std::string_view name, double value) {
    return value > 0 ? attribute(name, value) : std::string();
}

/// Properties without an attribute in the extension have attributes in our own namespace, which other
/// programs ignore.
std::string profile_text(const std::string& uuid, const std::string& name, const Exposure& exposure) {
    const ParameterSet& set = exposure.parameters;
    return fmt::format(
        "<tp:toolpathprofile uuid=\"{}\" name=\"{}\"{}{}{}{}{} l:region=\"{}\" l:kind=\"{}\" "
        "l:contour=\"{}\" l:parameters=\"{}\"{}{}/>\n",
        uuid, xml_escaped(name), attribute("laserpower", std::max(0.0, set.power_w)),
        positive_attribute("laserspeed", set.speed_mm_s),
        positive_attribute("jumpspeed", set.jump_speed_mm_s), attribute("laserfocus", set.focus_mm),
        positive_attribute("spotradius", set.spot_mm / 2), scan_region_name(exposure.region),
        vector_kind_name(exposure.kind), exposure.contour, xml_escaped(set.name),
        attribute("l:markdelay", set.mark_delay_us), attribute("l:jumpdelay", set.jump_delay_us));
}

/// Returns the whole content of the header of a file, for identifiers that should be unique to the file.
std::string header_text(const LayerFileInfo& info) {
    std::string text = fmt::format("{} {}", info.layers, info.bottom);
    const auto add_box = [&](const Box3& box) {
        for (const Point3& p : {box.min, box.max})
            text += fmt::format(" {} {} {}", p.x, p.y, p.z);
    };
    add_box(info.box);
    for (const PartInfo& part : info.parts) {
        text += fmt::format(" \"{}\"", part.label);
        add_box(part.box);
        if (part.exposure)
            text += profile_text("", part.exposure->part, *part.exposure);
    }
    return text;
}

class Toolpath3mfWriter final : public package_3mf::PackageWriter {
  public:
    Toolpath3mfWriter(const std::string& path, const LayerFileInfo& info, const LayerWriteOptions& options)
        : PackageWriter(path, info,
                        {.hatches = true, .gaps = false, .parameters = true, .written_label = quotable},
                        "<Default Extension=\"xml\" ContentType=\"application/xml\"/>"),
          info_(info), keys_(info.parts), units_(options.units_mm), grid_(options.units_mm, &rounding_loss()),
          bottom_(whole_height(info.bottom)),
          heights_(fmt::format("units of {} mm; use smaller ones", options.units_mm), options.units_mm,
                   rounding_loss()) {
        heights_.add(static_cast<double>(bottom_), info.bottom, "bottom", 0);
        uuid_ = uuid_of("toolpath " + header_text(info));
        for (std::size_t part = 0; part < keys_.parts.size(); ++part)
            item_uuids_.push_back(uuid_of(fmt::format("item {} {}", part, uuid_)));
        const bool any_bare = std::any_of(info.parts.begin(), info.parts.end(),
                                          [](const PartInfo& part) { return !part.exposure; });
        for (std::size_t i = 0; i < keys_.exposures.size() + (any_bare ? 1 : 0); ++i)
            profile_uuids_.push_back(uuid_of(fmt::format("profile {} {}", i, uuid_)));
    }

  private:
    Write formatted(const Plane& plane) override {
        const std::shared_ptr<ByteBuffer> text = buffer();
        put_layer(plane, *text);
        auto chunk = std::make_shared<package_3mf::Chunk>(compressed(text->view()));
        chunk->bytes += deflate_end;
        return [this, chunk](const PlanePosition& offset, Completions& after) {
            const std::int64_t height = whole_height(offset.top);
            heights_.add(static_cast<double>(height), offset.top, "top", offset.index);
            const std::string name = fmt::format("Toolpath/Layers/layer{:05}.xml", offset.position + 1);
            zip().add_ready(name, ZipMethod::deflated, chunk->in_zip(), chunk, after);
            content_ += fmt::format(" {:08x}", chunk->crc);
            layers_ += fmt::format("<tp:toolpathlayer ztop=\"{}\" path=\"/{}\"/>\n", height, name);
            relations_ += fmt::format("<Relationship Id=\"layer{}\" Target=\"/{}\" Type=\"{}\"/>\n",
                                      offset.position + 1, name, toolpath_3mf::layer_type);
        };
    }

    void end_file() override {
        zip().add("3D/_rels/3dmodel.model.rels",
                  fmt::format("{}<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/"
                              "relationships\">\n{}</Relationships>\n",
                              xml_begin, relations_),
                  ZipMethod::deflated);
        zip().add("3D/3dmodel.model", model(), ZipMethod::deflated);
        zip().finish();
    }

    [[nodiscard]] std::int64_t whole_height(double z) const {
        const double units = std::nearbyint(z / units_);
        if (!(units >= 0 && units <= static_cast<double>(most_coordinate)))
            throw Error(
                ErrorKind::usage,
                fmt::format("a height of {} mm cannot be written in units of {} mm: those of the format "
                            "reach from 0 to {}",
                            z, units_, most_coordinate));
        return static_cast<std::int64_t>(units);
    }

    /// Returns the index of the profile of a part; the last profile has no parameters.
    [[nodiscard]] std::size_t profile_of(std::size_t part) const {
        return keys_.keys[part].exposure.value_or(keys_.exposures.size());
    }

    /// Writes the parts and profiles that a layer uses. Their numbers, from 1, are the same on all layers.
    void put_header(const Plane& plane, ByteBuffer& out) const {
        std::set<std::size_t> of_parts;
        std::set<std::size_t> profiles;
        for (std::size_t part = 0; part < plane.polylines.size(); ++part)
            if (plane.polylines[part].contours() > 0 || !plane.hatches[part].span().empty()) {
                of_parts.insert(keys_.keys[part].part);
                profiles.insert(profile_of(part));
            }
        out.append(fmt::format("{}<layer xmlns=\"{}\">\n<parts>\n", xml_begin, toolpath_3mf::space));
        for (const std::size_t i : of_parts)
            out.append(fmt::format("<part id=\"{}\" uuid=\"{}\"/>\n", i + 1, item_uuids_[i]));
        out.append("</parts>\n<profiles>\n");
        for (const std::size_t i : profiles)
            out.append(fmt::format("<profile id=\"{}\" uuid=\"{}\"/>\n", i + 1, profile_uuids_[i]));
        out.append("</profiles>\n");
    }

    void put_layer(const Plane& plane, ByteBuffer& out) const {
        put_header(plane, out);
        out.append("<segments>\n");
        std::vector<GridPoint> scratch;
        for (std::size_t part = 0; part < plane.polylines.size(); ++part) {
            const Layer& layer = plane.polylines[part];
            const std::string refers = fmt::format("profileid=\"{}\" partid=\"{}\"", profile_of(part) + 1,
                                                   keys_.keys[part].part + 1);
            for (std::size_t i = 0; i < layer.contours(); ++i) {
                const bool closed = layer.closed(i);
                const auto points = grid_.snap(
                    layer.contour(i), closed, closed ? ring_area(layer.contour(i)) : 0, layer.index, scratch);
                if (!points.empty())
                    put_segment(closed ? "loop" : "polyline", refers, points, {"<point x=\"", "\" y=\""},
                                layer, out);
            }
            if (const auto lines = grid_.snap_lines(plane.hatches[part].span(), layer.index); !lines.empty())
                put_segment("hatch", refers, lines, {"<hatch x1=\"", "\" y1=\"", "\" x2=\"", "\" y2=\""},
                            layer, out);
        }
        out.append("</segments>\n</layer>\n");
    }

    /// Writes a segment. `before` has the texts that precede the numbers of each element; two numbers are a
    /// point.
    static void put_segment(std::string_view type, std::string_view refers, std::span<const GridPoint> points,
                            std::initializer_list<std::string_view> before, const Layer& layer,
                            ByteBuffer& out) {
        constexpr std::string_view element_end = "\"/>\n";
        constexpr std::size_t per_point = 2 * (most_integer_digits + 12);
        out.append(fmt::format("<segment type=\"{}\" {}>\n", type, refers));
        char* at = out.room(points.size() * per_point);
        const auto* text = before.begin();
        for (const GridPoint& p : points) {
            for (const std::int64_t value : {p.x, p.y}) {
                if (value > most_coordinate || value < -most_coordinate)
                    throw Error(ErrorKind::usage,
                                fmt::format("layer {} has coordinates beyond 2^31 units; use larger ones",
                                            layer.index));
                at = put_integer(put_text(at, *text++), value);
            }
            if (text == before.end()) {
                at = put_text(at, element_end);
                text = before.begin();
            }
        }
        out.end_at(at);
        out.append("</segment>\n");
    }

    /// Returns the profiles; their names must differ.
    [[nodiscard]] std::string profiles() const {
        std::string text;
        std::set<std::string> names;
        for (std::size_t i = 0; i < keys_.exposures.size(); ++i) {
            const Exposure& exposure = keys_.exposures[i];
            std::string name = fmt::format("{} ({})", exposure.name(), exposure.parameters.name);
            if (!names.insert(name).second)
                name = fmt::format("{} {}", name, i + 1);
            text += profile_text(profile_uuids_[i], name, exposure);
        }
        if (profile_uuids_.size() > keys_.exposures.size())
            text += fmt::format("<tp:toolpathprofile uuid=\"{}\" name=\"no parameters\"/>\n",
                                profile_uuids_.back());
        return text;
    }

    [[nodiscard]] std::string model() const {
        const std::string toolpath_uuid = uuid_of("content" + content_ + ' ' + uuid_);
        const std::vector<Box3> boxes = boxes_of_parts();
        std::string objects;
        std::string items;
        for (std::size_t i = 0; i < keys_.parts.size(); ++i) {
            const std::size_t id = i + 2;
            objects +=
                fmt::format("<object id=\"{}\" p:UUID=\"{}\" type=\"model\" name=\"{}\">\n{}</object>\n", id,
                            uuid_of("object " + item_uuids_[i]), xml_escaped(keys_.parts[i]),
                            package_3mf::box_mesh(boxes[i].empty() ? info_.box : boxes[i]));
            items += fmt::format("<item objectid=\"{}\" p:UUID=\"{}\"/>\n", id, item_uuids_[i]);
        }
        return fmt::format(
            "{}<model unit=\"millimeter\" xml:lang=\"en-US\" "
            "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" "
            "xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\" xmlns:tp=\"{}\" "
            "xmlns:l=\"{}\" requiredextensions=\"p tp\">\n<resources>\n"
            "<tp:toolpathresource id=\"1\" uuid=\"{}\" unitfactor=\"{}\" toolpathtype=\"planar\">\n"
            "<tp:toolpathprofiles>\n{}</tp:toolpathprofiles>\n"
            "<tp:toolpathlayers zbottom=\"{}\">\n{}</tp:toolpathlayers>\n</tp:toolpathresource>\n"
            "{}</resources>\n<build p:UUID=\"{}\" tp:toolpathid=\"1\">\n{}</build>\n</model>\n",
            xml_begin, toolpath_3mf::space, toolpath_3mf::own_space, toolpath_uuid,
            exact_decimal_text(units_), profiles(), bottom_, layers_, objects,
            uuid_of("build " + toolpath_uuid), items);
    }

    [[nodiscard]] std::vector<Box3> boxes_of_parts() const {
        std::vector<Box3> boxes(keys_.parts.size());
        for (std::size_t i = 0; i < keys_.keys.size(); ++i)
            boxes[keys_.keys[i].part].add(info_.parts[i].box);
        return boxes;
    }

    LayerFileInfo info_;
    ExposureKeys keys_;
    double units_;
    WriterGrid grid_;
    std::string uuid_;                       ///< derived from data known before the first layer
    std::string content_;                    ///< checksums of the layers, for the identifier of the file
    std::vector<std::string> item_uuids_;    ///< of the parts of keys_
    std::vector<std::string> profile_uuids_; ///< of its exposures, then of vectors without parameters
    std::string layers_;                     ///< list of layers in the model
    std::string relations_;                  ///< their relationships
    std::int64_t bottom_;
    WrittenHeights heights_;
};

} // namespace

std::unique_ptr<LayerWriter> open_toolpath_3mf(const std::string& path, const LayerFileInfo& info,
                                               const LayerWriteOptions& options) {
    check_units(options.units_mm);
    return std::make_unique<Toolpath3mfWriter>(path, info, options);
}

} // namespace lamella
