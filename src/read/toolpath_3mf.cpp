// The model contains the profiles of a toolpath and the list of its layers. Each layer is a part of the
// package, and refers to parts on the plate and to profiles by identifiers. Segments with the same part and
// profile become the layers of one part of the result.

#include "lamella/core/error.hpp"

#include "container/text_position.hpp"
#include "container/toolpath_3mf_format.hpp"
#include "container/xml.hpp"
#include "core/executor.hpp"
#include "read/layer_assembly.hpp"
#include "read/layer_pieces.hpp"
#include "read/layer_readers.hpp"
#include "read/read_limits.hpp"
#include "read/three_mf_part.hpp"
#include "read/three_mf_terms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <compare>
#include <exception>
#include <map>
#include <memory>
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
    LayerReader(const std::string& document, const Model& model, const Toolpath& toolpath,
                PartNumbers<SegmentKind>& kinds, Findings& found, RawLayer& raw, ReadLimits& limits)
        : document_(document), model_(model), toolpath_(toolpath), kinds_(kinds), found_(found), raw_(raw),
          limits_(limits), unit_mm_(toolpath.unit * model.unit_mm) {}

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

/// A toolpath, and the parts of the package with its layers.
struct ToolpathParts {
    /// One layer.
    struct Piece {
        RawLayer raw;
        PartNumbers<SegmentKind> kinds;
        Findings found = {};
        std::size_t end; ///< number of the next layer
    };

    const ZipReader& package;
    Model model;
    const Toolpath& toolpath; ///< of the model
    std::vector<std::string> layers = {};

    /// Returns the size of a unit of coordinates and heights.
    [[nodiscard]] double unit_mm() const { return toolpath.unit * model.unit_mm; }

    /// Reads the layer with this number. May be called by any number of threads at once.
    [[nodiscard]] Piece read(std::size_t number, ReadLimits& limits, const Executor& executor) const {
        Piece piece{.raw = {}, .kinds = PartNumbers<SegmentKind>(limits), .end = number + 1};
        piece.raw.z = toolpath.layers[number].top * unit_mm();
        piece.raw.begin = number;
        const ByteSource source = unpack_part(package, layers[number], limits);
        piece.raw.location = source.name;
        LayerReader reader(source.name, model, toolpath, piece.kinds, piece.found, piece.raw, limits);
        parse_part(source,
                   {.start = [&](const ThreeMfElement& element) { reader.start(element); },
                    .end =
                        [&](XmlName element) {
                            reader.end(element);
                        }},
                   executor);
        return piece;
    }
};

class ToolpathReader {
  public:
    ToolpathReader(const ZipReader& package, LayerFile& file, ReadLimits& limits, const Execution& execution)
        : package_(package), file_(file), limits_(limits), executor_(execution), kinds_(limits) {}

    void read() {
        const std::string root = root_model(package_);
        const ByteSource source = unpack_part(package_, root, limits_, &executor_);
        ToolpathModelReader reader(limits_);
        parse_part(source,
                   {.start =
                        [&](const ThreeMfElement& element) {
                            reader.start(element);
                        }},
                   executor_);
        Model model = reader.take();
        const Toolpath& toolpath = chosen(model, source.name);
        // Moving a map does not move what is in it.
        const auto parts = std::make_shared<ToolpathParts>(
            ToolpathParts{.package = package_, .model = std::move(model), .toolpath = toolpath});
        file_.units_mm = parts->unit_mm();
        file_.rounding = {.step_mm = file_.units_mm};
        std::vector<RawLayer> layers;
        limits_.make_room(layers, toolpath.layers.size(), [] { return std::string_view("the layers"); });
        read_layers(root, source.name, *parts, layers);
        if (layers.empty())
            throw Error(
                ErrorKind::input,
                fmt::format("{}: found a toolpath without layers; there must be one at least", source.name));
        number_parts(*parts, layers);
        make_layers(parts, layers);
        append_to(names_, file_.warnings);
        append_to(found_, file_.warnings);
    }

  private:
    /// Returns the toolpath to which the build refers, or the first one.
    [[nodiscard]] static const Toolpath& chosen(const Model& model, const std::string& document) {
        const auto found = model.chosen ? model.toolpaths.find(*model.chosen) : model.toolpaths.begin();
        if (found == model.toolpaths.end())
            throw Error(ErrorKind::input,
                        fmt::format("{}: found no toolpath; the build must have one", document));
        return found->second;
    }

    void read_layers(const std::string& root, const std::string& document, ToolpathParts& parts,
                     std::vector<RawLayer>& layers) {
        std::set<const ZipEntry*> known;
        std::uint64_t bytes = 0;
        std::exception_ptr error; // of the layer after those named
        try {
            for (const Toolpath::Listed& listed : parts.toolpath.layers) {
                std::string part = opc_resolved(package_, root, listed.path);
                const ZipEntry* const entry = package_.find(part);
                if (!known.insert(entry).second)
                    throw Error(
                        ErrorKind::input,
                        fmt::format(
                            "{}, line {}: found the layer '{}' a second time; each has a part of its own",
                            document, listed.line, printable(listed.path, 100)));
                limits_.add_bytes_at(sizeof part + part.size() + node_bytes, at_line(listed.line));
                parts.layers.push_back(std::move(part));
                bytes += entry == nullptr ? 0 : entry->size;
            }
        } catch (const Error&) {
            error = std::current_exception();
        }
        limits_.keep_text_in_memory(bytes);
        PieceBegins begins;
        for (std::size_t i = 0; i < parts.layers.size(); ++i)
            begins.push_back(i);
        if (!begins.empty())
            read_pieces(
                begins, begins.size(), executor_,
                [&](std::size_t i, std::size_t) {
                    executor_.check_cancelled();
                    ToolpathParts::Piece piece = parts.read(i, limits_, executor_);
                    piece.raw.end_layer(limits_);
                    return piece;
                },
                [&](ToolpathParts::Piece&& piece) {
                    kinds_.add(
                        piece.kinds, {&piece.raw, 1}, [](const SegmentKind& kind) { return kind; },
                        [&] { return std::string_view(piece.raw.location); });
                    found_.add(piece.found);
                    layers.push_back(std::move(piece.raw));
                });
        if (error)
            std::rethrow_exception(error);
    }

    /// Numbers parts in the order of the build, and exposures of each part in that of the profiles.
    void number_parts(const ToolpathParts& parts, std::vector<RawLayer>& layers) {
        std::vector<std::string> labels(parts.model.items.size());
        for (const auto& [uuid, item] : parts.model.items)
            labels[item.first] = item.second;
        std::vector<const Toolpath::Profile*> profiles(parts.toolpath.profiles.size());
        for (const auto& [uuid, profile] : parts.toolpath.profiles)
            profiles[profile.number] = &profile;
        ReadLabels read_labels;
        std::map<std::size_t, std::string> names; // of items with vectors
        kinds_.put(file_, layers, [&](const SegmentKind& kind) {
            const auto [name, is_new] = names.try_emplace(kind.item);
            if (is_new)
                name->second = names_.of(read_labels.of(labels[kind.item]));
            return part_of(kind, name->second, *profiles[kind.profile]);
        });
        if (file_.parts.empty())
            file_.parts.push_back({.label = labels.empty() ? std::string() : read_labels.of(labels.front())});
        read_labels.append_to(file_.warnings);
    }

    static PartInfo part_of(const SegmentKind& kind, const std::string& label,
                            const Toolpath::Profile& profile) {
        PartInfo part{.label = label, .box = {}, .exposure = profile.exposure};
        if (!part.exposure)
            return part;
        Exposure& exposure = *part.exposure;
        exposure.part = label;
        if (!profile.says_kind) {
            exposure.kind = kind.hatches ? VectorKind::hatch : VectorKind::contour;
            exposure.contour = kind.hatches ? 0 : 1;
        }
        part.label = exposure.label();
        return part;
    }

    void make_layers(std::shared_ptr<const ToolpathParts> parts, std::vector<RawLayer>& layers) {
        sort_by_height(layers, file_.warnings);
        check_part_planes(file_, layers.size(), package_.unpacked());
        const double bottom = std::min(parts->toolpath.bottom * file_.units_mm, layers.front().z);
        add_layers_by_tops(
            file_, layers, bottom, limits_, executor_,
            [parts = std::move(parts), kinds = kinds_.keys()](std::size_t begin, ReadLimits& limits) {
                const Execution silent{.threads = 1};
                ToolpathParts::Piece piece = parts->read(begin, limits, Executor(silent));
                piece.kinds.put(piece.raw, kinds);
                return std::move(piece.raw);
            });
    }

    const ZipReader& package_;
    LayerFile& file_;
    ReadLimits& limits_;
    Executor executor_;
    PartNumbers<SegmentKind> kinds_;
    DistinctNames names_;
    Findings found_;
};

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
    ToolpathReader(package, file, limits, execution).read();
    return file;
}

} // namespace lamella
