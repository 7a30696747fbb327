// The slices of a stack follow one another, and are nearly all of the text. They are read in pieces (see
// read/layer_pieces.hpp). Slices that are plain (see read/plain_elements.hpp) are read without an XML parser.
// A parser reads the others, and everything else in the part.

#include "read/slice_model_3mf.hpp"

#include "lamella/core/error.hpp"

#include "container/text_position.hpp"
#include "core/executor.hpp"
#include "read/decimal_text.hpp"
#include "read/layer_pieces.hpp"
#include "read/mesh_text.hpp"
#include "read/plain_elements.hpp"
#include "read/read_limits.hpp"
#include "read/three_mf_terms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

namespace lamella {

/// The tags of slices whose names have this prefix.
struct SliceTags {
    explicit SliceTags(std::string_view prefix)
        : before(prefix.empty() ? std::string() : fmt::format("{}:", prefix)) {}

    std::string before;
    std::string stack = before + "slicestack";
    std::string slice = "<" + before + "slice";
    std::string vertices = "<" + before + "vertices";
    std::string vertex = "<" + before + "vertex";
    std::string polygon = "<" + before + "polygon";
    std::string segment = "<" + before + "segment";
    std::string end_of_slice = "</" + before + "slice";
    std::string end_of_vertices = "</" + before + "vertices";
    std::string end_of_polygon = "</" + before + "polygon";
};

/// The text of a part, and what is needed to read its plain slices.
struct SliceText {
    ByteSource part;
    std::size_t last_tag;
    std::vector<std::string> prefixes; ///< of attributes
    SliceTags tags;
};

namespace {

struct SliceWarnings {
    CountedWarning open{"contour is open", "contours are open"};
    ReturningChains returning;
    DroppedContours dropped;

    void add(const SliceWarnings& later) {
        open.add(later.open);
        returning.add(later.returning);
        dropped.add(later.dropped);
    }
};

/// Reads slices of one stack, element by element. A `where` describes the position of an element. Functions
/// that return false have found an element that breaks a rule.
class SliceReader {
  public:
    /// The slices must lie above `bottom`.
    SliceReader(double bottom, ReadLimits& limits)
        : stack_(std::make_shared<SliceStack>(SliceStack{bottom, {}})), limits_(limits) {}
    SliceReader(SliceReader&&) noexcept = default;
    SliceReader& operator=(SliceReader&&) = delete;
    ~SliceReader() { limits_.give_back(0, vertices_.capacity() * sizeof(Point2)); }

    /// Handles an element as the parser finds it.
    void start(const ThreeMfElement& element) {
        line_ = element.line;
        if (element.name.space != three_mf::slices)
            return;
        const std::string_view name = element.name.local;
        const auto location = at_line(line_);
        if (name == "slice") {
            const double top = element["ztop"].number();
            if (!start_slice(top, location))
                element.fail(fmt::format("a slice with ztop = {}", top),
                             fmt::format("it to lie above z = {}", stack_->top()));
        } else if (name == "vertex" && in_slice()) {
            add_vertex({element["x"].number(), element["y"].number()}, location);
        } else if (name == "polygon" && in_slice()) {
            const std::uint32_t index = element["startv"].index();
            if (!start_polygon(index, location))
                fail_for_vertex(element, index);
        } else if (name == "segment" && in_slice() && start_) {
            const std::uint32_t index = element["v2"].index();
            if (!add_point(index, location))
                fail_for_vertex(element, index);
        }
    }

    void end(XmlName element) {
        if (element == XmlName{three_mf::slices, "polygon"} && in_slice())
            end_polygon(at_line(line_));
    }

    template <class Where>
    bool start_slice(double top, const Where& where) {
        if (!(top > stack_->top()))
            return false;
        limits_.make_room(stack_->slices, 1, where);
        stack_->slices.emplace_back().top = top;
        vertices_.clear();
        return true;
    }

    template <class Where>
    void add_vertex(const Point2& vertex, const Where& where) {
        limits_.make_room(vertices_, 1, where);
        vertices_.push_back(vertex);
    }

    template <class Where>
    bool start_polygon(std::uint32_t index, const Where& where) {
        Slice& slice = stack_->slices.back();
        if (slice.text) // this polygon follows the end of its slice, so that is not plain
            slice = Slice{slice.top, slice.read_again(limits_)};
        start_ = index;
        return add_point(index, where);
    }

    template <class Where>
    bool add_point(std::uint32_t index, const Where& where) {
        if (index >= vertices_.size())
            return false;
        last_ = index;
        std::vector<Point2>& points = raw().points;
        // Usually, each vertex is used once, and the first one of a polygon is its last one, too.
        limits_.make_room(points, points.empty() ? vertices_.size() + 1 : 1, where);
        points.push_back(vertices_[index]);
        return true;
    }

    template <class Where>
    void end_polygon(const Where& where) {
        if (!start_)
            return;
        const bool returning_chain = last_ != start_ && raw().is_returning_chain();
        const bool closed = last_ == start_ || returning_chain;
        if (returning_chain)
            warnings_.returning.note(where);
        else if (!closed)
            warnings_.open.note(where);
        raw().end_contour(closed, 0, limits_, where, warnings_.dropped);
        start_.reset();
    }

    /// Frees the contours of the last slice, which begins at this offset of the text.
    void drop_contents(const std::shared_ptr<const SliceText>& text, std::size_t begin) {
        Slice& slice = stack_->slices.back();
        slice.raw.begin = begin;
        slice.raw.end_layer(limits_);
        slice.text = text;
    }

    /// Appends a stack to this one. The tops of all its slices must be above this stack. Its first slice
    /// begins at the top of this stack.
    void append(const SliceStack& other, const ThreeMfElement& reference) {
        for (const Slice& slice : other.slices) {
            if (!(slice.top > stack_->top()))
                reference.fail(fmt::format("a reference to slices that end at z = {}", slice.top),
                               fmt::format("them to lie above z = {}", stack_->top()));
            limits_.make_room(stack_->slices, 1, reference.location());
            limits_.add_bytes_at(contour_bytes(slice.raw), reference.location());
            stack_->slices.push_back(slice);
        }
    }

    /// Appends the slices that follow in the file. Returns false, and changes nothing, if they do not lie
    /// above these slices.
    [[nodiscard]] bool append(SliceReader&& later) {
        std::vector<Slice>& slices = stack_->slices;
        std::vector<Slice>& more = later.stack_->slices;
        if (!more.empty() && !(more.front().top > stack_->top()))
            return false;
        if (slices.empty()) {
            slices.swap(more);
        } else {
            limits_.make_room(slices, more.size(), at_line(later.line_));
            std::move(more.begin(), more.end(), std::back_inserter(slices));
        }
        limits_.give_back(0, more.capacity() * sizeof(Slice));
        more = {};
        warnings_.add(later.warnings_);
        vertices_.swap(later.vertices_);
        line_ = later.line_;
        return true;
    }

    /// Calls `read`. If it returns false or throws Error{input}, removes what it added, and returns false.
    template <class Read>
    bool try_to(const Read& read) {
        const std::size_t before = stack_->slices.size();
        SliceWarnings warnings = std::exchange(warnings_, SliceWarnings());
        bool is_read = false;
        try {
            is_read = read();
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::input)
                throw;
        }
        if (is_read)
            warnings.add(warnings_);
        else
            remove_from(before);
        warnings_ = std::move(warnings);
        return is_read;
    }

    [[nodiscard]] const std::shared_ptr<SliceStack>& stack() const { return stack_; }
    [[nodiscard]] const SliceWarnings& warnings() const { return warnings_; }
    [[nodiscard]] bool in_polygon() const { return start_.has_value(); }

  private:
    [[nodiscard]] bool in_slice() const { return !stack_->slices.empty(); }
    RawLayer& raw() { return stack_->slices.back().raw; }

    [[noreturn]] void fail_for_vertex(const ThreeMfElement& element, std::uint32_t index) const {
        element.fail(fmt::format("vertex {}", index),
                     fmt::format("less than {}, the number of vertices of the slice", vertices_.size()));
    }

    void remove_from(std::size_t position) {
        std::vector<Slice>& slices = stack_->slices;
        for (; slices.size() > position; slices.pop_back()) {
            const RawLayer& raw = slices.back().raw;
            limits_.give_back(0, raw.points.capacity() * sizeof(Point2) +
                                     raw.ends.capacity() * sizeof(RawLayer::Contour));
        }
        start_.reset();
    }

    std::shared_ptr<SliceStack> stack_;
    SliceWarnings warnings_;
    ReadLimits& limits_;
    std::vector<Point2> vertices_;       ///< of the last slice
    std::optional<std::uint32_t> start_; ///< first vertex of the polygon under construction
    std::uint32_t last_ = 0;
    std::size_t line_ = 0; ///< of the last element
};

/// Reads a slice that is plain. `lines` are those of the whole text.
class PlainSlice {
  public:
    PlainSlice(std::string_view text, std::size_t begin, std::size_t end,
               std::span<const std::string> prefixes, const SliceTags& tags, SliceReader& reader,
               LineCounter& lines)
        : text_(text), tags_(tags), reader_(reader), lines_(lines),
          elements_(text.substr(begin, end - begin), prefixes) {}

    /// Returns false if the slice is not plain.
    bool read() {
        const PlainTagEnd end = start_slice();
        return end == PlainTagEnd::element || (end == PlainTagEnd::start_tag && read_vertices() &&
                                               read_polygons() && take_end(tags_.end_of_slice));
    }

    /// Returns the offset of what follows the slice.
    [[nodiscard]] std::size_t end() { return offset(elements_.next()); }

  private:
    [[nodiscard]] std::size_t offset(const char* position) const {
        return static_cast<std::size_t>(position - text_.data());
    }

    [[nodiscard]] auto at(const char* tag) const {
        return [this, tag] {
            return fmt::format("line {}", lines_.line(offset(tag)));
        };
    }

    bool take_end(std::string_view tag) { return elements_.take(tag) && elements_.take(">"); }

    PlainValue number(int index, const char* text, double& value) const {
        const char* const end = read_decimal(text, elements_.end(), value);
        return {index, std::abs(value) <= farthest_coordinate ? end : nullptr};
    }

    /// Reads the rest of a tag, in which the attribute `name` is an index.
    PlainTagEnd take_index(std::string_view name, std::uint32_t& value) {
        return elements_.take_attributes(
            1, [&](const char* other, std::size_t length, const char* text) -> PlainValue {
                if (std::string_view(other, length) != name)
                    return {};
                return {0, read_index(text, elements_.end(), value)};
            });
    }

    PlainTagEnd start_slice() {
        const char* const tag = elements_.next();
        double top = 0;
        if (!elements_.take(tags_.slice))
            return PlainTagEnd::none;
        const PlainTagEnd end =
            elements_.take_attributes(1, [&](const char* name, std::size_t length, const char* value) {
                return std::string_view(name, length) == "ztop" ? number(0, value, top) : PlainValue();
            });
        return end != PlainTagEnd::none && reader_.start_slice(top, at(tag)) ? end : PlainTagEnd::none;
    }

    bool read_vertices() {
        if (!elements_.take(tags_.vertices))
            return true;
        const PlainTagEnd end =
            elements_.take_attributes(0, [](const char*, std::size_t, const char*) { return PlainValue(); });
        if (end != PlainTagEnd::start_tag)
            return end == PlainTagEnd::element;
        for (const char* tag = elements_.next(); elements_.take(tags_.vertex); tag = elements_.next()) {
            double xy[2] = {};
            const auto read = [&](const char* name, std::size_t length, const char* value) {
                const bool wanted = length == 1 && (*name == 'x' || *name == 'y');
                return wanted ? number(*name - 'x', value, xy[*name - 'x']) : PlainValue();
            };
            if (elements_.take_attributes(2, read) != PlainTagEnd::element)
                return false;
            reader_.add_vertex({xy[0], xy[1]}, at(tag));
        }
        return take_end(tags_.end_of_vertices);
    }

    bool read_polygons() {
        for (const char* tag = elements_.next(); elements_.take(tags_.polygon); tag = elements_.next())
            if (!read_polygon(tag))
                return false;
        return true;
    }

    bool read_polygon(const char* tag) {
        std::uint32_t index = 0;
        const PlainTagEnd end = take_index("startv", index);
        if (end == PlainTagEnd::none || !reader_.start_polygon(index, at(tag)))
            return false;
        if (end == PlainTagEnd::start_tag) {
            for (const char* next = elements_.next(); elements_.take(tags_.segment);
                 next = elements_.next()) {
                tag = next;
                if (take_index("v2", index) != PlainTagEnd::element || !reader_.add_point(index, at(tag)))
                    return false;
            }
            if (!take_end(tags_.end_of_polygon))
                return false;
        }
        reader_.end_polygon(at(tag));
        return true;
    }

    std::string_view text_;
    const SliceTags& tags_;
    SliceReader& reader_;
    LineCounter& lines_;
    PlainElements elements_;
};

/// Returns the prefix that a part probably declares for slices.
std::optional<std::string_view> slice_prefix(std::string_view text) {
    constexpr std::size_t longest_root = std::size_t{1} << 16;
    constexpr std::string_view declares = "xmlns";
    const std::size_t space = text.substr(0, longest_root).find(three_mf::slices);
    if (space == std::string_view::npos)
        return std::nullopt;
    const std::string_view before = text.substr(0, space);
    std::string_view name = before.substr(0, before.find_last_of('='));
    name.remove_prefix(std::min(name.find_last_of(" \t\r\n") + 1, name.size()));
    if (!name.starts_with(declares))
        return std::nullopt;
    name.remove_prefix(declares.size());
    return name.substr(name.starts_with(':') ? 1 : 0);
}

class SliceModelReader {
  public:
    SliceModelReader(const ByteSource& part, const FindSliceStack& find, ReadLimits& limits,
                     Executor& executor)
        : part_(part), text_(part.text()), find_(find), limits_(limits), executor_(executor) {}

    SliceModel read() {
        ThreeMfHandlers handlers{.start = [this](const ThreeMfElement& element) { start(element); },
                                 .end =
                                     [this](XmlName element) {
                                         end(element);
                                     }};
        if (prefix_) {
            handlers.many = tags_.slice;
            handlers.skim = [this](std::size_t position) {
                return read_slices(position);
            };
        }
        parse_part(part_, handlers, executor_);
        warnings_.open.append_to(model_.warnings);
        warnings_.returning.append_to(model_.warnings);
        warnings_.dropped.append_to(model_.warnings);
        return std::move(model_);
    }

  private:
    void start(const ThreeMfElement& element) {
        if (depth_++ == 0)
            start_root(element);
        if (element.name == XmlName{three_mf::slices, "slicestack"})
            start_stack(element);
        else if (element.name == XmlName{three_mf::slices, "sliceref"} && slices_)
            slices_->append(*find_(element), element);
        else if (slices_)
            slices_->start(element);
        if (element.name.space == three_mf::core)
            start_core_element(element);
    }

    void end(XmlName element) {
        --depth_;
        if (element == XmlName{three_mf::slices, "slicestack"})
            end_stack();
        else if (element == XmlName{three_mf::core, "object"})
            object_ = nullptr;
        else if (slices_)
            slices_->end(element);
    }

    void start_root(const ThreeMfElement& element) {
        spaces_ = &element.spaces;
        prefixes_ = plain_prefixes(element.spaces);
        const auto space = element.spaces.find(std::string(prefix_.value_or("")));
        in_pieces_ = space != element.spaces.end() && space->second == three_mf::slices;
        if (in_pieces_ && !limits_.in_memory())
            again_ = std::make_shared<const SliceText>(SliceText{part_, last_tag_, prefixes_, tags_});
    }

    void start_stack(const ThreeMfElement& element) {
        end_stack();
        const std::uint32_t id = element["id"].index();
        limits_.add_bytes_at(node_bytes + sizeof(SliceStack), element.location());
        if (model_.stacks.contains(id))
            element.fail(fmt::format("a second slice stack {}", id), "ids that differ");
        slices_.emplace(element["zbottom"].number_or(0), limits_);
        model_.stacks.emplace(id, slices_->stack());
        stack_depth_ = depth_;
    }

    void end_stack() {
        if (slices_)
            warnings_.add(slices_->warnings());
        slices_.reset();
    }

    void start_core_element(const ThreeMfElement& element) {
        const std::string_view name = element.name.local;
        if (name == "model") {
            model_.unit_mm = element.unit_mm();
            static_cast<void>(element.required_extensions());
        } else if (name == "object") {
            const std::string_view label = element["name"].text;
            limits_.add_bytes_at(node_bytes + sizeof(SlicedObject) + label.size(), element.location());
            const std::uint32_t id = element["id"].index();
            const auto [object, is_new] = model_.objects.try_emplace(
                id, SlicedObject{std::string(label), nullptr, {}, element.object_type()});
            if (!is_new)
                element.fail(fmt::format("id {} for the second time", id), "ids that differ");
            object_ = &object->second;
            if (const ThreeMfValue stack = element[XmlName{three_mf::slices, "slicestackid"}]; stack.is_there)
                object_->stack = stack_of(stack);
        } else if (name == "component" && object_ != nullptr) {
            limits_.make_room(object_->components, 1, element.location());
            object_->components.push_back(element.use(model_.unit_mm));
        } else if (name == "item") {
            limits_.make_room(model_.items, 1, element.location());
            model_.items.push_back(element.use(model_.unit_mm));
        }
    }

    [[nodiscard]] std::shared_ptr<const SliceStack> stack_of(const ThreeMfValue& id) const {
        const auto found = model_.stacks.find(id.index());
        if (found == model_.stacks.end())
            id.element.fail(fmt::format("slice stack {}", id.text), "one that is defined before it is used");
        return found->second;
    }

    struct Piece {
        SliceReader slices;
        std::size_t read_to = 0;                  ///< in the part
        std::uint64_t line = 0;                   ///< there
        std::size_t end = std::string_view::npos; ///< where the next piece begins, if there is one
        bool sound = true; ///< false if the parser of the part must read on, because of an error, for example
    };

    /// Reads the slices from `position` to the end of the stack.
    XmlSkimmed read_slices(std::size_t position) {
        const bool is_slice = slices_ && depth_ == stack_depth_ && !slices_->in_polygon();
        if (!is_slice || !in_pieces_)
            return {};
        const bool alone = executor_.workers() == 1; // reads the stack as one piece, without a pass ahead
        const std::string_view text =
            text_.substr(position, alone ? std::string_view::npos : end_of_stack(position) - position);
        // Slices probably begin like the first one, up to the value of an attribute.
        constexpr std::size_t longest = 64;
        const std::string_view first = text.substr(0, longest);
        const TextPieces pieces =
            alone ? TextPieces(text, {0})
                  : find_text_pieces(text, 0, first.substr(0, first.find_first_of("\"'>")), executor_);
        const std::uint64_t line = lines_.line(position);
        std::size_t read_to = position;
        read_pieces(
            pieces.begins(), text.size(), executor_,
            [&](std::size_t from, std::size_t limit) {
                LineCounter lines(text_, position + from, line + pieces.line(from) - 1);
                return read_piece(position, position + from, position + limit, lines);
            },
            [&](Piece&& piece) {
                in_pieces_ = in_pieces_ && slices_->append(std::move(piece.slices));
                if (!in_pieces_)
                    return;
                read_to = piece.read_to;
                lines_ = LineCounter(text_, read_to, piece.line);
                in_pieces_ = piece.sound;
            });
        return {read_to - position, lines_.line(read_to) - line};
    }

    /// Returns the probable end of the stack around `position`.
    std::size_t end_of_stack(std::size_t position) {
        const std::string tag = "</" + tags_.stack;
        if (!stack_ends_)
            stack_ends_.emplace(find_text_pieces(text_, 0, tag, executor_));
        // They are the first ones in each chunk; that of `position` may contain others.
        const PieceBegins& ends = stack_ends_->begins();
        const auto later = std::upper_bound(ends.begin(), ends.end(), position);
        const std::size_t end = later == ends.end() ? text_.size() : *later;
        const std::size_t nearer =
            text_.substr(position, std::min(end - position, layer_piece_bytes + tag.size())).find(tag);
        return nearer == std::string_view::npos ? end : position + nearer;
    }

    /// Reads slices from `begin` to the first one at or after `limit`, or to the end of the stack. The first
    /// piece begins at `first`.
    Piece read_piece(std::size_t first, std::size_t begin, std::size_t limit, LineCounter& lines) {
        Piece piece{.slices = SliceReader(-std::numeric_limits<double>::infinity(), limits_)};
        std::size_t at = begin;
        const auto read_plain = [&] {
            PlainSlice slice(text_, at, last_tag_, prefixes_, tags_, piece.slices, lines);
            if (!slice.read())
                return false;
            if (again_)
                piece.slices.drop_contents(again_, at);
            at = slice.end();
            return true;
        };
        const auto parse = [&] {
            const std::size_t end = std::min(limit, at + layer_piece_bytes);
            at = parse_part_elements(part_, at, end, tags_.stack, *spaces_, lines.line(at),
                                     {.start =
                                          [&](const ThreeMfElement& element) {
                                              if (!is_of_slices(element.name))
                                                  element.fail("an element that is not in a slice", "slices");
                                              piece.slices.start(element);
                                          },
                                      .end =
                                          [&](XmlName name) {
                                              piece.slices.end(name);
                                          }},
                                     executor_);
            return true;
        };
        while (at < limit) {
            executor_.check_cancelled();
            if (piece.slices.try_to(read_plain))
                continue;
            const bool stack_ends = text_.substr(at).starts_with("</");
            piece.sound = stack_ends || piece.slices.try_to(parse);
            if (stack_ends || !piece.sound)
                break;
        }
        piece.read_to = at;
        piece.line = lines.line(at);
        if (at >= limit)
            piece.end = at - first;
        return piece;
    }

    /// Returns whether an element in a stack has no meaning outside of slices.
    static bool is_of_slices(XmlName name) {
        return name.space == three_mf::slices ? name.local != "slicestack" && name.local != "sliceref"
                                              : name.space != three_mf::core;
    }

    const ByteSource& part_;
    std::string_view text_;
    std::size_t last_tag_ = text_.rfind('<');
    std::optional<std::string_view> prefix_ = slice_prefix(text_);
    SliceTags tags_{prefix_.value_or("")};
    const FindSliceStack& find_;
    ReadLimits& limits_;
    Executor& executor_;
    LineCounter lines_{text_};
    std::optional<TextPieces> stack_ends_; ///< offsets where stacks probably end
    const ThreeMfSpaces* spaces_ = nullptr;
    std::vector<std::string> prefixes_; ///< of attributes
    std::shared_ptr<const SliceText> again_; ///< null if layers are kept in memory
    bool in_pieces_ = false;
    std::size_t depth_ = 0;
    std::size_t stack_depth_ = 0;
    std::optional<SliceReader> slices_; ///< of the stack under construction
    SliceWarnings warnings_;
    SlicedObject* object_ = nullptr;
    SliceModel model_;
};

} // namespace

std::size_t Slice::points() const {
    if (!text)
        return raw.points.size();
    std::size_t points = 0;
    for (const RawLayer::Run& run : raw.runs)
        points += run.end - run.begin;
    return points;
}

RawLayer Slice::read_again(ReadLimits& limits) const {
    assert(text);
    SliceReader slices(-std::numeric_limits<double>::infinity(), limits);
    LineCounter lines(text->part.text());
    PlainSlice slice(text->part.text(), raw.begin, text->last_tag, text->prefixes, text->tags, slices, lines);
    [[maybe_unused]] const bool is_plain = slice.read();
    assert(is_plain);
    return std::move(slices.stack()->slices.front().raw);
}

std::uint64_t contour_bytes(const RawLayer& raw) {
    return raw.points.size() * sizeof(Point2) + raw.ends.size() * sizeof(RawLayer::Contour);
}

SliceModel read_slice_model(const ByteSource& part, const FindSliceStack& find, ReadLimits& limits,
                            Executor& executor) {
    return SliceModelReader(part, find, limits, executor).read();
}

} // namespace lamella
