// The model has the profiles of a toolpath and lists its layers; each layer is a part of the package, which
// names parts on the plate and profiles by identifiers. Segments that have part and profile in common are the
// layers of one part of what is read.

#include "lamella/core/error.hpp"

#include "container/text_place.hpp"
#include "container/toolpath_3mf_format.hpp"
#include "container/xml.hpp"
#include "core/executor.hpp"
#include "core/parse_number.hpp"
#include "read/layer_assembly.hpp"
#include "read/layer_readers.hpp"
#include "read/read_limits.hpp"
#include "read/three_mf_terms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <compare>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace lamella {

namespace {

bool is_toolpath(std::string_view space) {
    return space == toolpath_3mf::space || space == toolpath_3mf::draft_space;
}

std::string model_part(const OpcPackage& package) {
    for (const OpcRelationship& relationship : package.relationships(""))
        if (relationship.type == three_mf::model_type && !relationship.external)
            return relationship.target;
    return "3D/3dmodel.model";
}

// What is larger could make sums and areas overflow; no machine is near it.
constexpr double largest = 1e30;
constexpr double largest_unit = 1e12; ///< by which coordinates of 32 bits are multiplied

/// The element that is being read, for errors.
struct Element {
    const std::string& document;
    const XmlAttributes& attributes;
    std::size_t line;

    [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
        throw Error(ErrorKind::input,
                    fmt::format("{}, line {}: found {}; {}", document, line, found, expected));
    }
    [[nodiscard]] auto place() const {
        return [this] {
            return fmt::format("line {}", line);
        };
    }
    [[nodiscard]] std::string text(std::string_view name) const { return std::string(attributes.find(name)); }
    [[nodiscard]] std::int32_t whole(std::string_view name) const {
        const std::string_view value = attributes.find(name);
        std::int32_t number = 0;
        const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
        if (value.empty() || error != std::errc() || end != value.data() + value.size())
            fail(fmt::format("{} = '{}'", name, printable(value, 40)), "it must be a whole number");
        return number;
    }
    /// 0 where it is absent.
    template <class Name>
    [[nodiscard]] double number(Name name) const {
        const std::string_view value = attributes.find(name);
        if (value.data() == nullptr)
            return 0;
        double number = 0;
        if (parse_number(value.data(), value.data() + value.size(), number) != value.data() + value.size() ||
            value.empty() || !(std::abs(number) <= largest))
            fail(fmt::format("'{}'", printable(value, 40)),
                 fmt::format("a number within {:g} must stand there", largest));
        return number;
    }
};

/// What the model says of one toolpath.
struct Toolpath {
    struct Profile {
        std::size_t number = 0;           ///< in the order of the model
        std::optional<Exposure> exposure; ///< its part is set later
        bool says_kind = false;           ///< ours, which tell contours from hatches
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
    std::map<std::int32_t, std::string> objects;                      ///< names
    std::map<std::string, std::pair<std::size_t, std::string>> items; ///< by identifier: number and name
};

class ToolpathModelReader {
  public:
    ToolpathModelReader(const std::string& document, ReadLimits& limits)
        : document_(document), limits_(limits) {}

    void start(XmlName name, const XmlAttributes& attributes, std::size_t line) {
        const Element element{document_, attributes, line};
        if (is_toolpath(name.space))
            start_toolpath_element(name, element);
        else if (name.space == three_mf::core)
            start_core_element(name.local, element);
    }

    [[nodiscard]] Model take() { return std::move(model_); }

  private:
    void start_core_element(std::string_view name, const Element& element) {
        if (name == "model") {
            const std::string_view unit = element.attributes.find("unit");
            model_.unit_mm = unit.data() == nullptr ? 1 : three_mf::unit_mm(unit).value_or(0);
            if (model_.unit_mm == 0)
                element.fail(fmt::format("the unit '{}'", printable(unit, 40)),
                             "it must be millimeter or another of 3MF's");
        } else if (name == "object") {
            limits_.add_bytes_at(node_bytes + element.attributes.find("name").size(), element.place());
            model_.objects[element.whole("id")] = element.text("name");
        } else if (name == "build") {
            for (const std::string_view space : {toolpath_3mf::space, toolpath_3mf::draft_space})
                if (const std::string_view id = element.attributes.find(XmlName{space, "toolpathid"});
                    id.data() != nullptr)
                    model_.chosen = id_of(id, element);
        } else if (name == "item") {
            const std::string uuid(element.attributes.find(XmlName{three_mf::production, "UUID"}));
            const auto object = model_.objects.find(element.whole("objectid"));
            limits_.add_bytes_at(2 * node_bytes + 2 * uuid.size(), element.place());
            model_.items.try_emplace(uuid, model_.items.size(),
                                     object == model_.objects.end() ? std::string() : object->second);
        }
    }

    void start_toolpath_element(XmlName name, const Element& element) {
        if (name.local == "toolpathresource") {
            const std::uint32_t id = id_of(element.attributes.find("id"), element);
            limits_.add_bytes_at(node_bytes + sizeof(Toolpath), element.place());
            toolpath_ = &model_.toolpaths[id];
            *toolpath_ = {};
            toolpath_->unit = element.number("unitfactor");
            if (!(toolpath_->unit > 0 && toolpath_->unit <= largest_unit))
                element.fail(fmt::format("a unitfactor of {:g}", toolpath_->unit),
                             fmt::format("it must be above 0 and at most {:g}", largest_unit));
            if (const std::string type = element.text("toolpathtype"); !type.empty() && type != "planar")
                element.fail(fmt::format("a toolpath of type '{}'", printable(type, 40)),
                             "planar ones are read, which are made of layers");
        } else if (toolpath_ == nullptr) {
            element.fail(fmt::format("<{}> outside of a toolpath", name.local),
                         "it belongs to a toolpathresource");
        } else if (name.local == "toolpathprofile") {
            add_profile(element);
        } else if (name.local == "modifier") {
            element.fail("a modifier", "parameters that change along vectors are not read");
        } else if (name.local == "toolpathlayers") {
            toolpath_->bottom = element.number("zbottom");
        } else if (name.local == "toolpathlayer") {
            limits_.make_room(toolpath_->layers, 1, element.place());
            toolpath_->layers.push_back(
                {static_cast<double>(element.whole("ztop")), element.text("path"), element.line});
        }
    }

    void add_profile(const Element& element) {
        const auto own = [](std::string_view name) {
            return XmlName{toolpath_3mf::own_space, name};
        };
        Toolpath::Profile profile;
        Exposure exposure;
        ParameterSet& set = exposure.parameters;
        set = {.name = element.text("name"),
               .power_w = element.number("laserpower"),
               .speed_mm_s = element.number("laserspeed"),
               .jump_speed_mm_s = element.number("jumpspeed"),
               .focus_mm = element.number("laserfocus"),
               .spot_mm = 2 * element.number("spotradius"),
               .mark_delay_us = element.number(own("markdelay")),
               .jump_delay_us = element.number(own("jumpdelay"))};
        const std::string_view region = element.attributes.find(own("region"));
        const std::string_view kind = element.attributes.find(own("kind"));
        profile.says_kind = kind.data() != nullptr;
        if (profile.says_kind) {
            set.name = element.attributes.find(own("parameters"));
            exposure.kind =
                kind == vector_kind_name(VectorKind::hatch) ? VectorKind::hatch : VectorKind::contour;
            const double number = element.number(own("contour"));
            exposure.contour = number >= 0 && number <= 1e9 ? static_cast<std::uint32_t>(number) : 0;
        }
        for (const ScanRegion known :
             {ScanRegion::core, ScanRegion::upskin, ScanRegion::downskin, ScanRegion::support})
            if (region == scan_region_name(known))
                exposure.region = known;
        if (set.speed_mm_s > 0)
            profile.exposure = std::move(exposure);
        limits_.add_bytes_at(node_bytes + sizeof profile + set.name.size(), element.place());
        profile.number = toolpath_->profiles.size();
        if (!toolpath_->profiles.try_emplace(element.text("uuid"), std::move(profile)).second)
            element.fail(fmt::format("a second profile {}", printable(element.text("uuid"), 40)),
                         "identifiers must differ");
    }

    static std::uint32_t id_of(std::string_view text, const Element& element) {
        std::uint32_t id = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
        if (text.empty() || error != std::errc() || end != text.data() + text.size())
            element.fail(fmt::format("the number '{}' of a toolpath", printable(text, 40)),
                         "it must be a whole number");
        return id;
    }

    const std::string& document_;
    ReadLimits& limits_;
    Model model_;
    Toolpath* toolpath_ = nullptr;
};

/// What the segments of one part of the result have in common.
struct SegmentKind {
    std::size_t item = 0;
    std::size_t profile = 0;
    bool hatches = false; ///< where the profile does not say whether it is of hatches

    friend auto operator<=>(const SegmentKind&, const SegmentKind&) = default;
};

/// Numbers for the kinds of segments that were met.
using Slots = std::map<SegmentKind, std::uint32_t>;

class LayerReader {
  public:
    LayerReader(const std::string& document, const Model& model, const Toolpath& toolpath, Slots& slots,
                RawLayer& raw, ReadLimits& limits)
        : document_(document), model_(model), toolpath_(toolpath), slots_(slots), raw_(raw), limits_(limits),
          unit_mm_(toolpath.unit * model.unit_mm) {}

    void start(XmlName name, const XmlAttributes& attributes, std::size_t line) {
        if (!is_toolpath(name.space))
            return;
        const Element element{document_, attributes, line};
        if (name.local == "point" && in_contour_) {
            limits_.make_room(raw_.points, 1, element.place());
            raw_.points.push_back(point(element, "x", "y"));
        } else if (name.local == "hatch" && in_hatches_) {
            limits_.make_room(raw_.hatches, 2, element.place());
            raw_.hatches.push_back(point(element, "x1", "y1"));
            raw_.hatches.push_back(point(element, "x2", "y2"));
        } else if (name.local == "segment") {
            start_segment(element);
        } else if (name.local == "part") {
            add(parts_, element);
        } else if (name.local == "profile") {
            add(profiles_, element);
        }
    }

    void end(XmlName name, Oddity& dropped) {
        if (!is_toolpath(name.space) || name.local != "segment")
            return;
        const auto place = [&] {
            return fmt::format("{}, line {}", document_, line_);
        };
        if (in_contour_) {
            limits_.make_room(raw_.ends, 1, place);
            if (!raw_.end_clean_contour(begin_, closed_, slot_))
                dropped.note(place);
        } else if (in_hatches_) {
            limits_.make_room(raw_.hatch_ends, 1, place);
            raw_.end_hatches(slot_);
        }
        in_contour_ = in_hatches_ = false;
    }

  private:
    [[nodiscard]] Point2 point(const Element& element, std::string_view x, std::string_view y) const {
        return {element.whole(x) * unit_mm_ + 0.0, element.whole(y) * unit_mm_ + 0.0};
    }

    void add(std::map<std::int32_t, std::string>& to, const Element& element) {
        limits_.add_bytes_at(node_bytes, element.place());
        to[element.whole("id")] = element.text("uuid");
    }

    void start_segment(const Element& element) {
        const std::string type = element.text("type");
        in_hatches_ = type == "hatch";
        closed_ = type == "loop";
        in_contour_ = closed_ || type == "polyline";
        if (!in_hatches_ && !in_contour_)
            element.fail(fmt::format("a segment of type '{}'", printable(type, 40)),
                         "loops, polylines and hatches are read");
        line_ = element.line;
        begin_ = raw_.points.size();
        const auto part = parts_.find(element.whole("partid"));
        const auto profile = profiles_.find(element.whole("profileid"));
        if (part == parts_.end() || profile == profiles_.end())
            element.fail(part == parts_.end() ? "a segment of a part that the layer does not list"
                                              : "a segment of a profile that the layer does not list",
                         "it must be one that stands before the segments");
        const auto item = model_.items.find(part->second);
        const auto known = toolpath_.profiles.find(profile->second);
        if (item == model_.items.end() || known == toolpath_.profiles.end())
            element.fail(item == model_.items.end() ? "a segment of a part that is not in the build"
                                                    : "a segment of a profile that the model does not have",
                         "the model must have it");
        const bool says_kind = known->second.says_kind || !known->second.exposure;
        const SegmentKind kind{item->second.first, known->second.number, !says_kind && in_hatches_};
        if (!slots_.contains(kind))
            limits_.add_bytes_at(node_bytes + sizeof kind + 2 * sizeof(LayerPart), element.place());
        slot_ = slots_.try_emplace(kind, static_cast<std::uint32_t>(slots_.size())).first->second;
    }

    const std::string& document_;
    const Model& model_;
    const Toolpath& toolpath_;
    Slots& slots_;
    RawLayer& raw_;
    ReadLimits& limits_;
    double unit_mm_;
    std::map<std::int32_t, std::string> parts_; ///< identifiers by the numbers of the layer
    std::map<std::int32_t, std::string> profiles_;
    bool in_contour_ = false;
    bool in_hatches_ = false;
    bool closed_ = false;
    std::size_t begin_ = 0;
    std::size_t line_ = 0;
    std::uint32_t slot_ = 0;
};

class ToolpathReader {
  public:
    ToolpathReader(const OpcPackage& package, LayerFile& file, ReadLimits& limits, const Execution& execution)
        : package_(package), file_(file), limits_(limits), executor_(execution) {}

    void read() {
        const std::string root = model_part(package_);
        const ByteSource source = part(root);
        ToolpathModelReader reader(source.name, limits_);
        parse(source, [&](XmlName name, const XmlAttributes& attributes, std::size_t line) {
            reader.start(name, attributes, line);
        });
        model_ = reader.take();
        const Toolpath& toolpath = chosen(source.name);
        file_.units_mm = toolpath.unit * model_.unit_mm;
        file_.rounding = {.step_mm = file_.units_mm};
        std::vector<RawLayer> layers;
        std::set<std::string> known;
        for (const Toolpath::Listed& listed : toolpath.layers) {
            if (!known.insert(listed.path).second)
                throw Error(
                    ErrorKind::input,
                    fmt::format("{}, line {}: found the layer '{}' a second time; each has a part of its own",
                                source.name, listed.line, printable(listed.path, 100)));
            limits_.make_room(layers, 1, [&] { return fmt::format("line {}", listed.line); });
            layers.emplace_back().z = listed.top * file_.units_mm;
            read_layer(OpcPackage::resolve(root, listed.path), toolpath, layers.back());
        }
        if (layers.empty())
            throw Error(
                ErrorKind::input,
                fmt::format("{}: found a toolpath without layers; there must be one at least", source.name));
        number_parts(toolpath, layers);
        make_layers(toolpath, layers);
        dropped_.say(file_.warnings);
    }

  private:
    ByteSource part(const std::string& name) {
        const ZipEntry* const entry = package_.zip().find(name);
        if (entry == nullptr)
            throw Error(ErrorKind::input, fmt::format("{}: found no part '{}', to which the package refers",
                                                      package_.zip().name(), printable(name, 100)));
        return package_.zip().read(*entry);
    }

    template <class Start, class End>
    void parse(const ByteSource& source, const Start& start, const End& end) {
        XmlHandlers handlers;
        handlers.start = start;
        handlers.end = end;
        handlers.progress = [&](std::size_t) {
            executor_.check_cancelled();
        };
        parse_xml(source.text(), source.name, handlers,
                  {.namespaces = true, .utf8_only = true, .no_document_type = true});
    }
    template <class Start>
    void parse(const ByteSource& source, const Start& start) {
        parse(source, start, [](XmlName) {});
    }

    /// The toolpath that the build names, else the first one.
    [[nodiscard]] const Toolpath& chosen(const std::string& document) const {
        const auto found = model_.chosen ? model_.toolpaths.find(*model_.chosen) : model_.toolpaths.begin();
        if (found == model_.toolpaths.end())
            throw Error(ErrorKind::input,
                        fmt::format("{}: found no toolpath; the build must have one", document));
        return found->second;
    }

    void read_layer(const std::string& name, const Toolpath& toolpath, RawLayer& raw) {
        executor_.check_cancelled();
        const ByteSource source = part(name);
        raw.place = source.name;
        LayerReader reader(source.name, model_, toolpath, slots_, raw, limits_);
        parse(
            source,
            [&](XmlName element, const XmlAttributes& attributes, std::size_t line) {
                reader.start(element, attributes, line);
            },
            [&](XmlName element) { reader.end(element, dropped_); });
    }

    /// Parts in the order of the build, and exposures of each in that of the profiles.
    void number_parts(const Toolpath& toolpath, std::vector<RawLayer>& layers) {
        std::vector<std::string> labels(model_.items.size());
        for (const auto& [uuid, item] : model_.items)
            labels[item.first] = item.second;
        std::vector<const Toolpath::Profile*> profiles(toolpath.profiles.size());
        for (const auto& [uuid, profile] : toolpath.profiles)
            profiles[profile.number] = &profile;
        std::vector<std::uint32_t> places(slots_.size());
        for (const auto& [kind, slot] : slots_) {
            places[slot] = static_cast<std::uint32_t>(file_.parts.size());
            file_.parts.push_back(part_of(kind, labels[kind.item], *profiles[kind.profile]));
        }
        if (file_.parts.empty())
            file_.parts.push_back({labels.empty() ? std::string() : labels.front(), {}});
        for (RawLayer& layer : layers) {
            for (RawLayer::Contour& contour : layer.ends)
                contour.part = places[contour.part];
            for (RawLayer::Hatches& hatches : layer.hatch_ends)
                hatches.part = places[hatches.part];
        }
    }

    static LayerPart part_of(const SegmentKind& kind, const std::string& label,
                             const Toolpath::Profile& profile) {
        LayerPart part{label, {}, profile.exposure};
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

    void make_layers(const Toolpath& toolpath, std::vector<RawLayer>& layers) {
        sort_by_height(layers, file_.warnings);
        check_part_planes(file_, layers.size(), package_.zip().unpacked());
        double bottom = toolpath.bottom * file_.units_mm;
        for (std::size_t i = 0; i < layers.size(); ++i) {
            const double top = layers[i].z;
            bottom = std::min(bottom, top);
            add_layer(file_, layers[i], i, bottom + (top - bottom) / 2, bottom, top, limits_);
            bottom = top;
        }
    }

    const OpcPackage& package_;
    LayerFile& file_;
    ReadLimits& limits_;
    Executor executor_;
    Model model_;
    Slots slots_;
    Oddity dropped_{"contours had too few different points; they were dropped"};
};

} // namespace

bool is_toolpath_3mf(const OpcPackage& package) {
    const std::vector<OpcRelationship> all = package.relationships(model_part(package));
    return std::any_of(all.begin(), all.end(), [](const OpcRelationship& relationship) {
        return relationship.type == toolpath_3mf::layer_type ||
               relationship.type == toolpath_3mf::draft_layer_type;
    });
}

LayerFile read_toolpath_3mf(const OpcPackage& package, ReadLimits& limits, const Execution& execution) {
    LayerFile file;
    file.path = package.zip().name();
    file.format = "3mf-toolpath";
    file.warnings = package.zip().oddities();
    ToolpathReader(package, file, limits, execution).read();
    return file;
}

} // namespace lamella
