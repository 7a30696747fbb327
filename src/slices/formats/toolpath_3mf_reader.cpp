// The model contains the profiles of a toolpath and the list of its layers. Each layer is a part of the
// package, and refers to parts on the plate and to profiles by identifiers. Segments with the same part and
// profile become the layers of one part of the result.

#include "lamella/core/error.hpp"

#include "container/text_position.hpp"
#include "container/xml.hpp"
#include "core/executor.hpp"
#include "meshes/three_mf_part.hpp"
#include "meshes/three_mf_terms.hpp"
#include "slices/engine/layer_readers.hpp"
#include "slices/engine/slice_engine.hpp"
#include "slices/formats/toolpath_3mf_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <compare>
#include <exception>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace lamella {

namespace {

bool is_toolpath(std::string_view space) {
    return space == toolpath_3mf::space || space == toolpath_3mf::draft_space;
}

/// Returns whether a profile or a segment specifies a laser other than the first one.
bool is_other_laser(const ThreeMfElement& element) {
    const std::string_view index = element["laserindex"].text;
    return !index.empty() && index != "0";
}

constexpr double largest_unit = 1e12; ///< factor of the 32-bit coordinates

/// Properties of one toolpath in the model.
struct Toolpath {
    struct Profile {
        std::size_t number = 0;           ///< in the order of the model
        std::optional<Exposure> exposure; ///< its part is set later
        bool says_kind = false;           ///< true in Lamella's files, which distinguish contours from
                                          ///< hatches
        bool other_laser = false;         ///< true if it specifies a laser other than the first
    };
    struct Listed {
        double top;
        std::string path;
        std::size_t line;
    };

    double unit = 0; ///< in the unit of the model
    double bottom = 0;
    std::map<std::string, Profile> profiles; ///< by identifier
    std::vector<Listed> layers;
};

struct Model {
    double unit_mm = 1;
    std::map<std::uint32_t, Toolpath> toolpaths;
    std::optional<std::uint32_t> chosen;
    std::map<std::uint32_t, std::string> objects;                     ///< names
    std::map<std::string, std::pair<std::size_t, std::string>> items; ///< by identifier: number and name
};

class ToolpathModelReader {
  public:
    explicit ToolpathModelReader(ReadLimits& limits) : limits_(limits) {}

    void start(const ThreeMfElement& element) {
        if (is_toolpath(element.name.space))
            start_toolpath_element(element);
        else if (element.name.space == three_mf::core)
            start_core_element(element);
    }

    [[nodiscard]] Model take() { return std::move(model_); }

  private:
    void start_core_element(const ThreeMfElement& element) {
        const std::string_view name = element.name.local;
        if (name == "model") {
            model_.unit_mm = element.unit_mm();
        } else if (name == "object") {
            const std::string_view label = element["name"].text;
            limits_.add_bytes_at(node_bytes + label.size(), element.location());
            model_.objects[element["id"].index()] = label;
        } else if (name == "build") {
            for (const std::string_view space : {toolpath_3mf::space, toolpath_3mf::draft_space})
                if (const ThreeMfValue id = element[XmlName{space, "toolpathid"}]; id.is_there)
                    model_.chosen = id.index();
        } else if (name == "item") {
            const std::string uuid(element[XmlName{three_mf::production, "UUID"}].text);
            const auto object = model_.objects.find(element["objectid"].index());
            limits_.add_bytes_at(2 * node_bytes + 2 * uuid.size(), element.location());
            model_.items.try_emplace(uuid, model_.items.size(),
                                     object == model_.objects.end() ? std::string() : object->second);
        }
    }

    void start_toolpath_element(const ThreeMfElement& element) {
        const std::string_view name = element.name.local;
        if (name == "toolpathresource") {
            limits_.add_bytes_at(node_bytes + sizeof(Toolpath), element.location());
            toolpath_ = &model_.toolpaths[element["id"].index()];
            *toolpath_ = {};
            toolpath_->unit = element["unitfactor"].number();
            if (!(toolpath_->unit > 0 && toolpath_->unit <= largest_unit))
                element.fail(fmt::format("a unitfactor of {:g}", toolpath_->unit),
                             fmt::format("one above 0 and at most {:g}", largest_unit));
            if (const std::string_view type = element["toolpathtype"].text; !type.empty() && type != "planar")
                element.fail(fmt::format("a toolpath of type '{}'", printable(type, 40)),
                             "a planar one, which is made of layers");
        } else if (toolpath_ == nullptr) {
            element.fail(fmt::format("<{}> outside of a toolpath", name), "it in a toolpathresource");
        } else if (name == "toolpathprofile") {
            add_profile(element);
        } else if (name == "modifier") {
            element.fail("a modifier", "parameters that are the same along vectors; others are not read");
        } else if (name == "toolpathlayers") {
            toolpath_->bottom = element["zbottom"].number_or(0);
        } else if (name == "toolpathlayer") {
            limits_.make_room(toolpath_->layers, 1, element.location());
            toolpath_->layers.push_back({static_cast<double>(element["ztop"].whole()),
                                         std::string(element["path"].text), element.line});
        }
    }

    void add_profile(const ThreeMfElement& element) {
        const auto text = [&](std::string_view name) {
            return std::string(element[name].text);
        };
        const auto number = [&](std::string_view name) {
            return element[name].number_or(0);
        };
        const auto own = [&](std::string_view name) {
            return element[XmlName{toolpath_3mf::own_space, name}];
        };
        Toolpath::Profile profile;
        Exposure exposure;
        ParameterSet& set = exposure.parameters;
        set = {.name = text("name"),
               .power_w = number("laserpower"),
               .speed_mm_s = number("laserspeed"),
               .jump_speed_mm_s = number("jumpspeed"),
               .focus_mm = number("laserfocus"),
               .spot_mm = 2 * number("spotradius"),
               .mark_delay_us = own("markdelay").number_or(0),
               .jump_delay_us = own("jumpdelay").number_or(0)};
        if (const std::string_view name = negative_parameter(set); !name.empty())
            element.fail(fmt::format("a profile with a {} below 0", name), "0 or more");
        profile.other_laser = is_other_laser(element);
        const std::string_view region = own("region").text;
        const ThreeMfValue kind = own("kind");
        profile.says_kind = kind.is_there;
        if (profile.says_kind) {
            set.name = own("parameters").text;
            exposure.kind =
                kind.text == vector_kind_name(VectorKind::hatch) ? VectorKind::hatch : VectorKind::contour;
            const double contour = own("contour").number_or(0);
            exposure.contour = contour >= 0 && contour <= 1e9 ? static_cast<std::uint32_t>(contour) : 0;
        }
        for (const ScanRegion known :
             {ScanRegion::core, ScanRegion::upskin, ScanRegion::downskin, ScanRegion::support})
            if (region == scan_region_name(known))
                exposure.region = known;
        if (set.speed_mm_s > 0 || profile.says_kind)
            profile.exposure = std::move(exposure);
        limits_.add_bytes_at(node_bytes + sizeof profile + set.name.size(), element.location());
        profile.number = toolpath_->profiles.size();
        if (!toolpath_->profiles.try_emplace(text("uuid"), std::move(profile)).second)
            element.fail(fmt::format("a second profile {}", printable(text("uuid"), 40)),
                         "identifiers that differ");
    }

    ReadLimits& limits_;
    Model model_;
    Toolpath* toolpath_ = nullptr;
};

/// Properties that all segments of one part of the result share.
struct SegmentKind {
    std::size_t item = 0;
    std::size_t profile = 0;
    bool hatches = false; ///< used if the profile does not specify the kind

    friend auto operator<=>(const SegmentKind&, const SegmentKind&) = default;
};

class LayerReader {
  public:
    /// Reads the last one of these layers.
    LayerReader(const std::string& document, const Model& model, const Toolpath& toolpath,
                KeyedLayers<SegmentKind>& layers, ReadLimits& limits)
        : document_(document), model_(model), toolpath_(toolpath), kinds_(layers.parts), found_(layers.found),
          raw_(layers.layers.back()), limits_(limits), unit_mm_(toolpath.unit * model.unit_mm) {}

    void start(const ThreeMfElement& element) {
        if (!is_toolpath(element.name.space))
            return;
        const std::string_view name = element.name.local;
        if (name == "point" && in_contour_) {
            limits_.make_room(raw_.points, 1, element.location());
            raw_.points.push_back(point(element, "x", "y"));
        } else if (name == "hatch" && in_hatches_) {
            limits_.make_room(raw_.hatches, 2, element.location());
            raw_.hatches.push_back(point(element, "x1", "y1"));
            raw_.hatches.push_back(point(element, "x2", "y2"));
        } else if (name == "segment") {
            start_segment(element);
        } else if (name == "part") {
            add(parts_, element);
        } else if (name == "profile") {
            add(profiles_, element);
        }
    }

    void end(XmlName name) {
        if (!is_toolpath(name.space) || name.local != "segment")
            return;
        const auto where = [this] {
            return location();
        };
        if (in_contour_)
            raw_.end_contour(closed_, kind_, limits_, where, found_);
        else if (in_hatches_)
            raw_.end_hatches(kind_, limits_, where);
        in_contour_ = in_hatches_ = false;
    }

  private:
    /// Returns the position of the segment.
    [[nodiscard]] std::string location() const { return fmt::format("{}, line {}", document_, line_); }

    [[nodiscard]] Point2 point(const ThreeMfElement& element, std::string_view x, std::string_view y) const {
        return {element[x].whole() * unit_mm_ + 0.0, element[y].whole() * unit_mm_ + 0.0};
    }

    void add(std::map<std::int32_t, std::string>& to, const ThreeMfElement& element) {
        limits_.add_bytes_at(node_bytes, element.location());
        to[element["id"].whole()] = element["uuid"].text;
    }

    void start_segment(const ThreeMfElement& element) {
        const std::string_view type = element["type"].text;
        in_hatches_ = type == "hatch";
        closed_ = type == "loop";
        in_contour_ = closed_ || type == "polyline";
        if (!in_hatches_ && !in_contour_)
            element.fail(fmt::format("a segment of type '{}'", printable(type, 40)),
                         "loop, polyline or hatch");
        line_ = element.line;
        const auto part = parts_.find(element["partid"].whole());
        const auto profile = profiles_.find(element["profileid"].whole());
        if (part == parts_.end() || profile == profiles_.end())
            element.fail(part == parts_.end() ? "a segment of a part that the layer does not list"
                                              : "a segment of a profile that the layer does not list",
                         "one that stands before the segments");
        const auto item = model_.items.find(part->second);
        const auto known = toolpath_.profiles.find(profile->second);
        if (item == model_.items.end() || known == toolpath_.profiles.end())
            element.fail(item == model_.items.end() ? "a segment of a part that is not in the build"
                                                    : "a segment of a profile that the model does not have",
                         "one of the model");
        if (known->second.other_laser || is_other_laser(element))
            found_.note(FindingKind::segments_of_lasers, [this] { return location(); });
        const bool says_kind = known->second.says_kind || !known->second.exposure;
        kind_ = kinds_.number_of({item->second.first, known->second.number, !says_kind && in_hatches_},
                                 element.location());
    }

    const std::string& document_;
    const Model& model_;
    const Toolpath& toolpath_;
    PartNumbers<SegmentKind>& kinds_;
    Findings& found_;
    RawLayer& raw_;
    ReadLimits& limits_;
    double unit_mm_;
    std::map<std::int32_t, std::string> parts_; ///< identifiers by the numbers of the layer
    std::map<std::int32_t, std::string> profiles_;
    bool in_contour_ = false;
    bool in_hatches_ = false;
    bool closed_ = false;
    std::size_t line_ = 0;
    std::uint32_t kind_ = 0; ///< its number
};

/// Returns the toolpath to which the build refers, or the first one.
const Toolpath& chosen_toolpath(const Model& model, const std::string& document) {
    const auto found = model.chosen ? model.toolpaths.find(*model.chosen) : model.toolpaths.begin();
    if (found == model.toolpaths.end())
        throw Error(ErrorKind::input,
                    fmt::format("{}: found no toolpath; the build must have one", document));
    return found->second;
}

/// A toolpath, and the parts of the package with its layers. A piece is one layer.
class ToolpathLayers {
  public:
    using Piece = KeyedLayers<SegmentKind>;

    /// Finds the parts, up to the first one that cannot be that of a layer.
    ToolpathLayers(const ZipReader& package, const std::string& root, const std::string& document,
                   Model model, ReadLimits& limits)
        : package_(package), model_(std::move(model)), toolpath_(chosen_toolpath(model_, document)),
          all_(limits) {
        if (toolpath_.layers.empty())
            throw Error(
                ErrorKind::input,
                fmt::format("{}: found a toolpath without layers; there must be one at least", document));
        std::set<const ZipEntry*> known;
        try {
            for (const Toolpath::Listed& listed : toolpath_.layers) {
                std::string part = opc_resolved(package, root, listed.path);
                const ZipEntry* const entry = package.find(part);
                if (!known.insert(entry).second)
                    throw Error(
                        ErrorKind::input,
                        fmt::format(
                            "{}, line {}: found the layer '{}' a second time; each has a part of its own",
                            document, listed.line, printable(listed.path, 100)));
                limits.add_bytes_at(sizeof part + part.size() + node_bytes, at_line(listed.line));
                parts_.push_back(std::move(part));
                bytes_ += entry == nullptr ? 0 : entry->size;
            }
        } catch (const Error&) {
            unsound_ = std::current_exception();
        }
    }
    ToolpathLayers(const ToolpathLayers&) = delete;
    ToolpathLayers& operator=(const ToolpathLayers&) = delete;

    /// Returns the number of bytes to which the parts unpack.
    [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
    /// Returns the size of a unit of coordinates and heights.
    [[nodiscard]] double unit_mm() const { return toolpath_.unit * model_.unit_mm; }
    [[nodiscard]] double bottom() const { return toolpath_.bottom * unit_mm(); }

    [[nodiscard]] PieceBegins begins(Executor& /*executor*/) const {
        PieceBegins begins(end());
        std::iota(begins.begin(), begins.end(), std::size_t{0});
        return begins;
    }
    [[nodiscard]] std::size_t end() const { return toolpath_.layers.size(); }

    [[nodiscard]] Piece parse(std::size_t begin, std::size_t /*limit*/, const Reading& reading) const {
        reading.executor.check_cancelled();
        if (begin == parts_.size())
            std::rethrow_exception(unsound_);
        Piece piece(reading.limits);
        piece.end = begin + 1;
        const ByteSource source = unpack_part(package_, parts_[begin], reading.limits);
        reading.limits.make_room(piece.layers, 1, [&] { return std::string_view(source.name); });
        RawLayer& raw = piece.layers.emplace_back();
        raw.z = toolpath_.layers[begin].top * unit_mm();
        raw.begin = begin;
        raw.location = source.name;
        LayerReader reader(source.name, model_, toolpath_, piece, reading.limits);
        parse_part(source,
                   {.start = [&](const ThreeMfElement& element) { reader.start(element); },
                    .end =
                        [&](XmlName element) {
                            reader.end(element);
                        }},
                   reading.executor);
        reading.progress.add(source.bytes.size());
        return piece;
    }
    [[nodiscard]] RawLayer layer(Piece&& piece) const { return std::move(piece).only(kinds_); }
    void append(Piece&& piece, ReadLimits& limits) { all_.append(std::move(piece), limits); }

    /// Returns the layers. Numbers parts in the order of the build, and exposures of each part in that of the
    /// profiles.
    [[nodiscard]] std::vector<RawLayer> take_layers(LayerFile& file, VectorParts& names) {
        std::vector<std::string> labels(model_.items.size());
        for (const auto& [uuid, item] : model_.items)
            labels[item.first] = item.second;
        std::vector<const Toolpath::Profile*> profiles(toolpath_.profiles.size());
        for (const auto& [uuid, profile] : toolpath_.profiles)
            profiles[profile.number] = &profile;
        all_.parts.put(file, all_.layers, [&](const SegmentKind& kind) {
            const Toolpath::Profile& profile = *profiles[kind.profile];
            std::optional<Exposure> exposure = profile.exposure;
            if (exposure && !profile.says_kind) {
                exposure->kind = kind.hatches ? VectorKind::hatch : VectorKind::contour;
                exposure->contour = kind.hatches ? 0 : 1;
            }
            return names.of(static_cast<std::int64_t>(kind.item), labels[kind.item], std::move(exposure));
        });
        if (file.parts.empty())
            file.parts.push_back({.label = labels.empty() ? std::string() : names.labels.of(labels.front())});
        names.labels.append_to(file.warnings);
        kinds_ = all_.parts.keys();
        return std::move(all_.layers);
    }
    [[nodiscard]] const Findings& found() const { return all_.found; }

  private:
    const ZipReader& package_;
    Model model_;
    const Toolpath& toolpath_; ///< of the model
    std::vector<std::string> parts_;
    std::uint64_t bytes_ = 0;
    std::exception_ptr unsound_; ///< the reason why the layer behind `parts_` has no part
    Piece all_;
    std::vector<SegmentKind> kinds_; ///< of the parts of the file
};

Model read_toolpath_model(const ByteSource& source, ReadLimits& limits, const Executor& executor) {
    ToolpathModelReader reader(limits);
    parse_part(source,
               {.start =
                    [&](const ThreeMfElement& element) {
                        reader.start(element);
                    }},
               executor);
    return reader.take();
}

} // namespace

bool is_toolpath_3mf(const ZipReader& package) {
    const std::vector<OpcRelationship> all = opc_relationships(package, root_model(package));
    return std::any_of(all.begin(), all.end(), [](const OpcRelationship& relationship) {
        return relationship.type == toolpath_3mf::layer_type ||
               relationship.type == toolpath_3mf::draft_layer_type;
    });
}

LayerFile read_toolpath_3mf(const ZipReader& package, ReadLimits& limits, const Execution& execution) {
    LayerFile file = layer_file(package.name(), "3mf-toolpath");
    file.warnings = package.counted_warnings();
    const std::string root = root_model(package);
    Executor executor(execution);
    const ByteSource source = unpack_part(package, root, limits, &executor);
    const auto toolpath = std::make_shared<ToolpathLayers>(
        package, root, source.name, read_toolpath_model(source, limits, executor), limits);
    limits.keep_text_in_memory(toolpath->bytes());
    file.units_mm = toolpath->unit_mm();
    file.rounding = {.step_mm = file.units_mm};
    read_layers_of(*toolpath, limits, execution, toolpath->bytes());
    VectorParts names;
    std::vector<RawLayer> layers = toolpath->take_layers(file, names);
    sort_by_height(layers, file.warnings);
    check_part_planes(file, layers.size(), package.unpacked());
    add_layers_by_tops(file, layers, std::min(toolpath->bottom(), layers.front().z), limits, execution,
                       parsing_again<ToolpathLayers>(toolpath));
    append_to(names.names, file.warnings);
    append_to(toolpath->found(), file.warnings);
    return file;
}

} // namespace lamella
