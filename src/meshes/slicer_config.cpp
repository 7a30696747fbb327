#include "meshes/slicer_config.hpp"

#include "lamella/core/error.hpp"

#include "container/decimal_text.hpp"
#include "container/read_limits.hpp"
#include "container/text_position.hpp"
#include "container/xml.hpp"
#include "core/counted.hpp"
#include "core/executor.hpp"
#include "core/lower_case.hpp"
#include "meshes/remarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace lamella {

namespace {

constexpr std::size_t longest_name = 200;

constexpr std::array<std::pair<std::string_view, MeshRole>, 12> words = {{
    {"modelpart", MeshRole::part},
    {"normal_part", MeshRole::part},
    {"negativevolume", MeshRole::negative},
    {"negative_part", MeshRole::negative},
    {"parametermodifier", MeshRole::modifier},
    {"modifier_part", MeshRole::modifier},
    {"supportblocker", MeshRole::support_blocker},
    {"support_blocker", MeshRole::support_blocker},
    {"supportenforcer", MeshRole::support_enforcer},
    {"support_enforcer", MeshRole::support_enforcer},
    {"modifier", MeshRole::modifier},
    {"support", MeshRole::support},
}};

bool is_config(const ZipEntry& entry) {
    std::string name = lower_case(entry.name);
    std::replace(name.begin(), name.end(), '\\', '/');
    return name.starts_with("metadata/") &&
           (name.ends_with("_model.config") || name == "metadata/model_settings.config");
}

/// Reads one of these parts. Malformed ids are ignored.
class ConfigReader {
  public:
    ConfigReader(SlicerConfig& config, ReadLimits& limits, Occurrences& unknown, std::string& first_unknown)
        : config_(config), limits_(limits), unknown_(unknown), first_unknown_(first_unknown) {}

    void start(XmlName name, const XmlAttributes& attributes, std::size_t line) {
        const auto text = [&](std::string_view attribute) {
            return attributes.find(attribute);
        };
        ++depth_;
        if (name.local == "object" && depth_ == 2) {
            object_ = nullptr;
            limits_.add_bytes_at(node_bytes + sizeof(SlicerObject), at_line(line));
            if (const auto id = number(text("id")))
                object_ = &config_[*id];
        } else if (object_ != nullptr && name.local == "volume" && depth_ == 3) {
            const auto first = number(text("firstid"));
            const auto last = number(text("lastid"));
            limits_.make_room(object_->volumes, 1, at_line(line));
            if (first && last && *first <= *last) {
                object_->volumes.push_back({*first, *last + std::uint64_t{1}});
                in_volume_ = true;
            }
        } else if (object_ != nullptr && name.local == "part" && depth_ == 3) {
            limits_.make_room(object_->parts, 1, at_line(line));
            if (const auto id = number(text("id"))) {
                object_->parts.push_back({*id, role(text("subtype"), line)});
                in_part_ = true;
            }
        } else if (name.local == "metadata" && depth_ == 4) {
            add_metadata(text("key"), text("value"), line);
        }
    }

    void end() {
        if (--depth_ == 2)
            in_volume_ = in_part_ = false;
        if (depth_ == 1)
            object_ = nullptr;
    }

  private:
    static std::optional<std::uint32_t> number(std::string_view text) {
        std::uint32_t value = 0;
        const char* const end = text.data() + text.size();
        if (text.empty() || read_index(text.data(), end, value) != end)
            return std::nullopt;
        return value;
    }

    MeshRole role(std::string_view word, std::size_t line) {
        if (word.empty())
            return MeshRole::part;
        const std::optional<MeshRole> known = slicer_role(word);
        if (!known) {
            if (unknown_.count == 0)
                first_unknown_ = printable(word, longest_name);
            unknown_.note(line);
        }
        return known.value_or(MeshRole::part);
    }

    void add_metadata(std::string_view key, std::string_view value, std::size_t line) {
        if (in_volume_) {
            VolumeRange& volume = object_->volumes.back();
            if (key == "volume_type")
                volume.role = role(value, line);
            else if (key == "modifier" && value == "1" && volume.role == MeshRole::part)
                volume.role = MeshRole::modifier;
            else if (key == "name")
                volume.name = printable(value, longest_name);
        } else if (in_part_ && key == "name") {
            object_->parts.back().name = printable(value, longest_name);
        }
    }

    SlicerConfig& config_;
    ReadLimits& limits_;
    Occurrences& unknown_;
    std::string& first_unknown_;
    int depth_ = 0;
    SlicerObject* object_ = nullptr;
    bool in_volume_ = false;
    bool in_part_ = false;
};

} // namespace

std::optional<MeshRole> slicer_role(std::string_view word) {
    const std::string lower = lower_case(word);
    for (const auto& [known, role] : words)
        if (known == lower)
            return role;
    return std::nullopt;
}

SlicerConfig read_slicer_config(const ZipReader& package, Remarks& remarks, ReadLimits& limits,
                                Executor& executor) {
    SlicerConfig config;
    for (const ZipEntry& entry : package.entries()) {
        if (!is_config(entry))
            continue;
        const ByteSource part = unpacked_entry(package, entry, limits);
        SlicerConfig read;
        Occurrences unknown;
        std::string first_unknown;
        ConfigReader reader(read, limits, unknown, first_unknown);
        XmlHandlers handlers;
        handlers.start = [&](XmlName name, const XmlAttributes& attributes, std::size_t line) {
            reader.start(name, attributes, line);
        };
        handlers.end = [&](XmlName) {
            reader.end();
        };
        handlers.progress = [&](std::size_t) {
            executor.check_cancelled();
        };
        try {
            parse_xml(part.text(), part.name, handlers);
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::input)
                throw;
            remarks.add(
                fmt::format("what volumes are for cannot be read, all are taken as parts: {}", error.what()));
            continue;
        }
        if (unknown.count != 0)
            remarks.add(fmt::format("part '{}', line {}: {} of an unknown type ('{}'), taken as {}",
                                    printable(entry.name, longest_name), unknown.first,
                                    counted(unknown.count, "volume is", "volumes are"), first_unknown,
                                    unknown.count == 1 ? "a part" : "parts"));
        for (auto& [id, object] : read) {
            SlicerObject& known = config[id];
            known.volumes.insert(known.volumes.end(), object.volumes.begin(), object.volumes.end());
            known.parts.insert(known.parts.end(), object.parts.begin(), object.parts.end());
        }
    }
    return config;
}

} // namespace lamella
