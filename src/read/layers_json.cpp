#include "container/json_text.hpp"
#include "container/text_position.hpp"
#include "core/executor.hpp"
#include "core/farthest.hpp"
#include "read/layer_assembly.hpp"
#include "read/layer_readers.hpp"
#include "read/read_limits.hpp"
#include "read/text_chunks.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <vector>

namespace lamella {

namespace {

constexpr std::string_view format_name = "lamella layers";

class LayersJsonReader {
  public:
    LayersJsonReader(JsonText& text, std::uint64_t bytes, LayerFile& file, ReadLimits& limits,
                     const Execution& execution)
        : text_(text), bytes_(bytes), file_(file), limits_(limits), executor_(execution),
          progress_(execution, Stage::read, bytes) {}

    void read() {
        text_.object([&](const std::string& key) {
            if (key == "format")
                check_format();
            else if (key == "version")
                check_version();
            else if (key == "units")
                check_units();
            else if (key == "parts")
                read_parts();
            else if (key == "rule")
                read_rule();
            else if (key == "layers")
                read_layers();
            else
                text_.skip();
        });
        text_.end();
        if (!known_)
            text_.fail("no \"format\"", fmt::format("it must be \"{}\"", format_name));
        if (file_.parts.empty() || file_.parts.front().layers.empty())
            text_.fail("no layer", "a slice file must have at least one");
        dropped_.append_to(file_.warnings);
        progress_.finish();
    }

  private:
    void check_format() {
        const std::string name = text_.string();
        if (name != format_name)
            text_.fail(fmt::format("the format '{}'", printable(name, 40)),
                       fmt::format("of JSON files, '{}' is read", format_name));
        known_ = true;
    }

    void check_version() {
        const double version = text_.number();
        if (version != 1)
            text_.fail(fmt::format("version {}", version), "version 1 is read");
    }

    void check_units() {
        if (const std::string units = text_.string(); units != "mm")
            text_.fail(fmt::format("units of '{}'", printable(units, 40)), "lengths are read in 'mm'");
    }

    void read_rule() {
        const std::string name = text_.string();
        const std::optional<PlaneRule> rule = plane_rule(name);
        if (!rule)
            text_.fail(fmt::format("the rule '{}'", printable(name, 40)),
                       "planes are cut by section_above or section_below");
        file_.rule = *rule;
    }

    // Parts precede the layers, because all have the same planes.
    void read_parts() {
        if (!file_.parts.empty())
            text_.fail("\"parts\" a second time", "they must come once, before the layers");
        ReadLabels labels;
        text_.array([&] {
            std::string label;
            text_.object([&](const std::string& key) {
                if (key == "label")
                    label = text_.string();
                else
                    text_.skip();
            });
            make_room(file_.parts);
            label = labels.of(label);
            file_.parts.push_back({label, {}, labelled_exposure(label)});
        });
        labels.append_to(file_.warnings);
    }

    void read_layers() {
        if (!known_ || file_.parts.empty())
            text_.fail("layers", "\"format\" and \"parts\" must come before them");
        if (!file_.parts.front().layers.empty())
            text_.fail("\"layers\" a second time", "they must come once");
        text_.array([&] { read_layer(); });
    }

    double length() {
        const double value = text_.number();
        if (is_too_far(value))
            text_.fail(fmt::format("{}", value), fmt::format("lengths must lie within {} mm", farthest_mm));
        return value + 0.0;
    }

    void read_layer() {
        executor_.check_cancelled();
        double index = static_cast<double>(file_.parts.front().layers.size());
        std::optional<double> z;
        std::optional<double> bottom;
        std::optional<double> top;
        RawLayer raw;
        std::uint32_t parts = 0;
        text_.object([&](const std::string& key) {
            if (key == "index")
                index = text_.number();
            else if (key == "z")
                z = length();
            else if (key == "bottom")
                bottom = length();
            else if (key == "top")
                top = length();
            else if (key == "parts")
                text_.array([&] { read_part(raw, parts++); });
            else
                text_.skip();
        });
        constexpr double most_index = 9e15;
        if (!(index >= 0 && index <= most_index) || index != std::floor(index))
            text_.fail(fmt::format("the index {}", index), "it must be a whole number");
        if (!z || !bottom || !top || !(*bottom <= *z && *z <= *top))
            text_.fail("a layer that is not cut between its bottom and its top",
                       "z must lie between bottom and top");
        const LayerStack& before = file_.parts.front().layers;
        if (!before.empty() && !(before.back().z < *z))
            text_.fail(fmt::format("z = {} behind z = {}", *z, before.back().z), "layers must ascend");
        if (parts != file_.parts.size())
            text_.fail(fmt::format("a layer of {} parts", parts),
                       fmt::format("the file has {}", file_.parts.size()));
        check_part_planes(file_, before.size() + 1, bytes_);
        add_layer(file_, raw, static_cast<std::uint64_t>(index), *z, *bottom, *top, limits_);
        report_progress();
    }

    void report_progress() {
        progress_.add(text_.at() - reported_);
        reported_ = text_.at();
    }

    void read_part(RawLayer& raw, std::uint32_t part) {
        if (part >= file_.parts.size())
            text_.fail(fmt::format("part {} of a layer", part + 1),
                       fmt::format("the file has {}", file_.parts.size()));
        text_.object([&](const std::string& key) {
            if (key == "rings" || key == "chains")
                text_.array([&] {
                    read_points(raw.points);
                    raw.end_contour(key == "rings", part, limits_, at_byte(text_.at()), dropped_);
                });
            else if (key == "hatches")
                read_hatches(raw, part);
            else
                text_.skip();
        });
    }

    void read_hatches(RawLayer& raw, std::uint32_t part) {
        const std::size_t begin = raw.hatches.size();
        read_points(raw.hatches);
        if ((raw.hatches.size() - begin) % 2 != 0)
            text_.fail("half a hatch line", "each must have two points");
        raw.end_hatches(part, limits_, at_byte(text_.at()));
    }

    /// Makes room for one more item.
    template <class T>
    void make_room(std::vector<T>& items) {
        limits_.make_room(items, 1, at_byte(text_.at()));
    }

    // Reads x and y alternately.
    void read_points(std::vector<Point2>& to) {
        bool half = false;
        text_.array([&] {
            const double value = length();
            constexpr std::size_t stretch = std::size_t{1} << 22;
            if (text_.at() - reported_ > stretch) {
                executor_.check_cancelled();
                report_progress();
            }
            if (half) {
                to.back().y = value;
            } else {
                make_room(to);
                to.push_back({value, 0});
            }
            half = !half;
        });
        if (half)
            text_.fail("an x without its y", "coordinates must come in pairs");
    }

    JsonText& text_;
    std::uint64_t bytes_;
    LayerFile& file_;
    ReadLimits& limits_;
    Executor executor_;
    ProgressMeter progress_;
    std::size_t reported_ = 0;
    bool known_ = false;
    DroppedContours dropped_;
};

} // namespace

bool is_json(std::string_view bytes) {
    const std::size_t first = bytes.find_first_not_of(" \t\r\n", after_byte_order_mark(bytes));
    return first != std::string_view::npos && bytes[first] == '{';
}

LayerFile read_layers_json(std::string_view bytes, const std::string& name, ReadLimits& limits,
                           const Execution& execution) {
    LayerFile file{.path = name, .format = "json", .units_mm = 1};
    JsonText text(bytes, name, after_byte_order_mark(bytes));
    LayersJsonReader(text, bytes.size(), file, limits, execution).read();
    return file;
}

} // namespace lamella
