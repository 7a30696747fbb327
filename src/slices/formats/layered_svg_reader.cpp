#include "lamella/core/error.hpp"

#include "container/text_chunks.hpp"
#include "container/text_position.hpp"
#include "container/xml.hpp"
#include "core/executor.hpp"
#include "core/lower_case.hpp"
#include "slices/engine/layer_readers.hpp"
#include "slices/engine/slice_engine.hpp"
#include "slices/formats/svg_outlines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace lamella {

namespace {

/// One <g> of the file. RawLayer::z is the value in the file.
struct Group : RawLayer {
    std::optional<double> slice_z;
    std::optional<double> height;
    double cut = 0; ///< height of the cut
    double bottom = 0;
    double top = 0;
};

/// Computes the heights of layers and sorts them by cut, which may differ from the order of tops. Slic3r 1.x
/// writes the cut in its scaled units, a millionth of the value in millimetres; later versions write the top
/// in millimetres.
void place_groups(std::vector<Group>& groups, std::vector<std::string>& warnings) {
    double highest = 0;
    bool has_slice_z = false;
    for (const Group& group : groups) {
        highest = std::max(highest, std::abs(group.z));
        has_slice_z = has_slice_z || group.slice_z.has_value();
    }
    const bool legacy = !has_slice_z && highest < 0.01;
    for (Group& group : groups)
        group.z *= legacy ? 1e6 : 1;
    // Layers with different cuts are different layers, even if their tops are rounded to the same value.
    sort_by_height(groups, warnings,
                   [](const Group& a, const Group& b) { return a.z == b.z && a.slice_z == b.slice_z; });
    const std::size_t n = groups.size();
    const auto step_below = [&](std::size_t i) {
        const auto z = [&](std::size_t k) {
            return groups[k].z;
        };
        if (i > 0)
            return z(i) - z(i - 1);
        return n > 1 ? z(1) - z(0) : std::max(0.0, z(0));
    };
    for (std::size_t i = 0; i < n; ++i) {
        Group& group = groups[i];
        const double thickness = group.height.value_or(step_below(i));
        group.top = legacy ? group.z + thickness / 2 : group.z;
        group.bottom = group.top - thickness;
        const double middle = group.bottom + thickness / 2;
        group.cut = legacy ? group.z : group.slice_z.value_or(middle);
        // The cut may be outside of the layer, because heights are rounded separately or come from other
        // programs. Extend the layer to it.
        group.bottom = std::min(group.bottom, group.cut);
        group.top = std::max(group.top, group.cut);
    }
    const auto below = [](const Group& a, const Group& b) {
        return a.cut < b.cut;
    };
    if (!std::is_sorted(groups.begin(), groups.end(), below)) // sorting takes memory
        std::stable_sort(groups.begin(), groups.end(), below);
    // Heights and thicknesses are rounded separately. A layer within this distance of the one below counts as
    // adjoining it.
    constexpr double rounding = 1e-3;
    for (std::size_t i = 1; i < n; ++i) {
        const double top_below = groups[i - 1].top;
        if (std::abs(groups[i].bottom - top_below) <= rounding && top_below <= groups[i].cut)
            groups[i].bottom = top_below;
    }
}

/// Reads the elements of a document, or of layers of it.
class SvgReader {
  public:
    SvgReader(const std::string& name, ReadLimits& limits) : name_(name), limits_(limits) {}

    /// Returns a reader of layers of this document, in which their first line is `line`.
    [[nodiscard]] SvgReader of_layers(std::uint64_t line, ReadLimits& limits) const {
        SvgReader reader(name_, limits);
        reader.depth_ = 1;
        reader.canvas_ = canvas_;
        reader.even_odd_root_ = even_odd_root_;
        reader.line_ = line;
        return reader;
    }

    /// Appends the layers that follow. Returns false, and changes nothing, if their parts are not numbered
    /// as they must be; reading them here reports it.
    [[nodiscard]] bool append(SvgReader&& piece) {
        std::size_t known = parts_.size();
        for (const MetPart& part : piece.met_) {
            if (part.number > known + 1)
                return false;
            known = std::max(known, part.number);
        }
        for (const MetPart& part : piece.met_)
            meet(part);
        append_layers(layers, std::move(piece.layers), limits_);
        found_.add(piece.found_);
        return true;
    }

    /// Returns true within the root element, but outside of its elements.
    [[nodiscard]] bool is_in_root() const { return depth_ == 1; }

    /// Returns the start tag of the root element, without attributes.
    [[nodiscard]] std::string parent() const { return fmt::format("<{}>", root_); }

    /// Returns handlers that read with this reader. `held` counts the bytes for the longest attribute.
    [[nodiscard]] XmlHandlers handlers(std::uint64_t& held) {
        return {.start =
                    [this](XmlName name, const XmlAttributes& attributes, std::size_t line) {
                        start_element(
                            {name_, name.local, attributes, static_cast<std::size_t>(line + line_ - 1)});
                    },
                .end = [this](XmlName) { end_element(); },
                .hold =
                    [this, &held](std::size_t token) {
                        // The parser's buffer, the one before it, and the values of attributes.
                        const std::uint64_t taken = 4 * std::uint64_t{token};
                        if (taken <= held)
                            return;
                        limits_.add_bytes_at(taken - held,
                                             [] { return std::string_view("a long attribute"); });
                        held = taken;
                    },
                .element =
                    [this](std::size_t position) {
                        position_ = position;
                    }};
    }

    /// Puts what the document has into `file`, and returns the layers.
    [[nodiscard]] std::vector<Group> finish(LayerFile& file) {
        if (layers.empty())
            throw Error(ErrorKind::input,
                        fmt::format("{}: found no layer; a layered SVG holds one <g> with slic3r:z for "
                                    "each layer",
                                    name_));
        file.rule = rule_;
        file.parts = std::move(parts_);
        labels_.append_to(file.warnings);
        if (!canvas_.warning().empty())
            file.warnings.push_back(canvas_.warning());
        append_to(found_, file.warnings);
        return std::move(layers);
    }

    std::vector<Group> layers;
    std::size_t end = std::string_view::npos; ///< of a piece: where the next one begins; npos after an error

  private:
    void start_element(const SvgElement& element) {
        const bool is_root = depth_++ == 0;
        const std::string_view kind = element.local();
        if (is_root) {
            start_document(element);
        } else if (depth_ == 2 && kind == "g") {
            start_layer(element);
        } else {
            const bool has_points = kind == "polygon" || kind == "polyline";
            if (!in_layer_ && (has_points || kind == "path"))
                found_.note(FindingKind::outside_outlines, element.location());
            else if (!in_layer_)
                return;
            else if (has_points)
                add_svg_points(element, kind == "polygon", drawing());
            else if (kind == "path")
                add_svg_path(element, even_odd_, drawing());
            else if (kind == "g")
                start_part(element);
            else if (kind != "title" && kind != "desc")
                found_.note(FindingKind::other_elements, element.location());
        }
        if ((is_root || in_layer_) && !element["transform"].empty())
            found_.note(FindingKind::unfollowed_transforms, element.location());
    }

    void end_element() {
        if (--depth_ == 1) {
            if (in_layer_ && !is_piece())
                layers.back().end_layer(limits_);
            in_layer_ = false;
        }
        if (depth_ == 2)
            part_ = 0;
    }

    void start_document(const SvgElement& root) {
        root_ = root.name;
        if (root.local() != "svg")
            root.fail(fmt::format("found <{}>; the document must be <svg>", printable(root.name, 40)));
        canvas_ = SvgCanvas(root);
        even_odd_root_ = root.is_even_odd(false);
        if (const std::string_view name = root["data-lamella-rule"]; name.data() != nullptr) {
            const std::optional<PlaneRule> rule = plane_rule(name);
            if (!rule)
                root.fail(fmt::format("found the rule '{}'; planes are cut by section_above or "
                                      "section_below",
                                      printable(name, 40)));
            rule_ = *rule;
        }
    }

    void start_layer(const SvgElement& element) {
        const auto z = element.number("slic3r:z");
        if (!z)
            return; // a group without z, such as a legend
        in_layer_ = true;
        Group group;
        group.z = *z;
        group.location = fmt::format("line {}", element.line);
        group.begin = position_;
        group.slice_z = element.number("slic3r:slice-z");
        group.height = element.number("slic3r:layer-height");
        if (group.height && *group.height < 0)
            element.fail(fmt::format("found a layer height of {}; it must not be below 0", *group.height));
        limits_.make_room(layers, 1, element.location());
        layers.push_back(std::move(group));
        even_odd_ = element.is_even_odd(even_odd_root_);
    }

    [[nodiscard]] SvgDrawing drawing() { return {canvas_, layers.back(), part_, limits_, found_}; }

    /// Lamella's own files put each of several parts into a group, numbered from 1.
    void start_part(const SvgElement& element) {
        const auto part = depth_ == 3 ? element.number("data-lamella-part") : std::nullopt;
        if (!part)
            return;
        const std::size_t known = parts_.size();
        constexpr double most = std::numeric_limits<std::uint32_t>::max();
        if (!(*part >= 1 && *part <= (is_piece() ? most : static_cast<double>(known + 1))) ||
            *part != std::floor(*part))
            element.fail(fmt::format("found part {}; parts are numbered, and {} came so far", *part, known));
        part_ = static_cast<std::uint32_t>(*part) - 1;
        MetPart met{static_cast<std::size_t>(part_) + 1, std::string(element["data-lamella-label"]),
                    element.line};
        if (!is_piece())
            return meet(met);
        if (const auto [labelled, added] = labelled_.try_emplace(met.number, false);
            added || (!labelled->second && !met.label.empty())) {
            labelled->second = !met.label.empty();
            limits_.add_bytes_at(2 * node_bytes + sizeof met + met.label.size(), element.location());
            met_.push_back(std::move(met));
        }
    }

    /// A part where its number or its label is new.
    struct MetPart {
        std::size_t number;
        std::string label;
        std::size_t line;
    };

    /// Makes the part if it is the next one, and sets its label unless it has one.
    void meet(const MetPart& part) {
        if (part.number > parts_.size()) {
            limits_.make_room(parts_, 1, at_line(part.line));
            parts_.push_back({.label = {}});
        }
        if (PartInfo& drawn = parts_[part.number - 1]; drawn.label.empty()) {
            drawn.label = labels_.of(part.label);
            drawn.exposure = labelled_exposure(drawn.label);
        }
    }

    /// Returns whether this reads layers without the document around them.
    [[nodiscard]] bool is_piece() const { return root_.empty(); }

    const std::string& name_;
    ReadLimits& limits_;
    std::string root_; ///< name of the root element
    std::uint64_t line_ = 1;
    std::size_t position_ = 0; ///< of the element
    PlaneRule rule_ = PlaneRule::section_above;
    SvgCanvas canvas_;
    std::vector<PartInfo> parts_ = {PartInfo{.label = {}}};
    std::vector<MetPart> met_;             ///< of a piece, in the order of the file
    std::map<std::size_t, bool> labelled_; ///< whether these parts of a piece have labels
    std::uint32_t part_ = 0;
    int depth_ = 0;
    bool in_layer_ = false;
    bool even_odd_root_ = false;
    bool even_odd_ = false; ///< of the current layer
    ReadLabels labels_;
    Findings found_;
};

/// Returns whether the document is in UTF-8, as far as its first line says.
bool is_utf8(std::string_view document) {
    const std::string_view text = document.substr(after_byte_order_mark(document));
    const std::string declaration =
        lower_case(text.starts_with("<?xml") ? text.substr(0, text.find("?>")) : std::string_view());
    return declaration.find("encoding") == std::string::npos ||
           declaration.find("utf-8") != std::string::npos;
}

/// A document, whose layers are parsed in pieces as long as these are well-formed on their own.
class SvgDocument {
  public:
    using Piece = SvgReader;

    SvgDocument(std::string_view bytes, const std::string& name, ReadLimits& limits)
        : bytes_(bytes), name_(name), limits_(limits), reader_(name, limits), in_pieces_(is_utf8(bytes)) {
        limits.keep_text_in_memory(bytes.size());
        if (!in_pieces_)
            limits.keep_in_memory();
    }

    /// Returns the layers, and puts everything else into `file`.
    [[nodiscard]] std::vector<Group> read(LayerFile& file, const Execution& execution) {
        Executor executor(execution);
        ProgressMeter progress(execution, Stage::read, bytes_.size());
        std::uint64_t held = 0;
        XmlHandlers handlers = reader_.handlers(held);
        std::size_t ahead = 0; // bytes whose progress was reported before the parser skipped them
        handlers.progress = [&](std::size_t read) {
            executor.check_cancelled();
            const std::size_t counted = std::min(read, ahead);
            ahead -= counted;
            progress.add(read - counted);
        };
        handlers.many = {"<g"};
        handlers.skim = [&](XmlCursor& cursor) {
            if (!reader_.is_in_root() || !in_pieces_)
                return;
            begin_ = at_ = cursor.position();
            read_layers_of(*this, limits_, executor, progress);
            cursor.move_to(at_);
            ahead += at_ - begin_;
        };
        parse_xml(bytes_, name_, handlers);
        progress.finish();
        return reader_.finish(file);
    }

    [[nodiscard]] PieceBegins begins(Executor& executor) {
        text_.emplace(find_text_pieces(bytes_, begin_, start_of_siblings(bytes_, begin_), executor));
        return text_->begins();
    }
    [[nodiscard]] std::size_t end() const { return bytes_.size(); }

    [[nodiscard]] SvgReader parse(std::size_t begin, std::size_t limit, const Reading& reading) const {
        reading.executor.check_cancelled();
        SvgReader piece = reader_.of_layers(reading.again ? 1 : text_->line(begin), reading.limits);
        if (!in_pieces_ && !reading.again)
            return piece;
        std::uint64_t held = 0;
        XmlHandlers handlers = piece.handlers(held);
        handlers.progress = [&](std::size_t) {
            reading.executor.check_cancelled();
        };
        try {
            piece.end = parse_xml_elements(bytes_, begin, limit, reader_.parent(), name_, handlers);
            reading.progress.add(piece.end - begin);
        } catch (const Error& error) {
            if (reading.again || error.kind() != ErrorKind::input)
                throw;
        }
        reading.limits.give_back(0, held);
        return piece;
    }
    [[nodiscard]] static RawLayer layer(SvgReader&& piece) { return only_layer(std::move(piece.layers)); }

    void append(SvgReader&& piece, ReadLimits& /*limits*/) {
        const std::size_t end = piece.end;
        in_pieces_ = in_pieces_ && end != std::string_view::npos && reader_.append(std::move(piece));
        if (in_pieces_)
            at_ = end;
    }

  private:
    std::string_view bytes_;
    const std::string& name_;
    ReadLimits& limits_;
    SvgReader reader_;
    std::atomic<bool> in_pieces_;    ///< false after a piece that cannot be read, or not on its own
    std::size_t begin_ = 0;          ///< of the pieces
    std::size_t at_ = 0;             ///< up to which they were appended
    std::optional<TextPieces> text_; ///< from `begin_` on
};

} // namespace

bool is_svg(std::string_view bytes) {
    constexpr std::size_t longest_preface = 1U << 16;
    const std::string_view begin = after_blanks(bytes.substr(0, longest_preface));
    return begin.starts_with('<') &&
           (begin.find("<svg") != std::string_view::npos || begin.find(":svg") != std::string_view::npos);
}

LayerFile read_layered_svg(std::string_view bytes, const std::string& name, ReadLimits& limits,
                           const Execution& execution) {
    LayerFile file = layer_file(name, "svg", 1);
    file.rounding = text_rounding;
    const auto document = std::make_shared<SvgDocument>(bytes, name, limits);
    std::vector<Group> groups = document->read(file, execution);
    place_groups(groups, file.warnings);
    check_part_planes(file, groups.size(), bytes.size());
    std::vector<PlacedLayer> planes;
    planes.reserve(groups.size());
    for (Group& group : groups)
        planes.push_back({&group, planes.size(), group.cut, group.bottom, group.top});
    add_layers(file, planes, limits, execution, parsing_again<SvgDocument>(document));
    return file;
}

} // namespace lamella
