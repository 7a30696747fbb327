// The slices of a stack follow one another, and are nearly all of the text. Several threads read them in
// pieces (see slices/engine/layer_pieces.hpp). Slices that are plain are scanned (see container/xml_cursor.hpp). A
// parser reads the others, and everything else in the part.

#include "slices/formats/slice_model_3mf.hpp"

#include "lamella/core/error.hpp"

#include "container/plain_values.hpp"
#include "container/read_limits.hpp"
#include "container/text_position.hpp"
#include "core/executor.hpp"
#include "meshes/three_mf_terms.hpp"
#include "slices/engine/layer_pieces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <iterator>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

namespace lamella {

/// The text of a part, and what is needed to read its plain slices.
struct SliceText {
    ByteSource part;
    std::size_t last_tag;
    std::vector<std::string> prefixes; ///< of attributes
    std::string before;                ///< prefix of the names of elements, such as "s:"
};

namespace {

/// Reads slices of one stack, element by element: those of a parser (ThreeMfElement), and plain ones
/// (PlainElement). A `where` describes the position of an element. Functions that return false have found an
/// element that is not plain or breaks a rule, and have changed nothing.
class SliceReader {
  public:
    /// The slices must lie above `bottom`.
    SliceReader(double bottom, ReadLimits& limits)
        : stack_(std::make_shared<SliceStack>(SliceStack{bottom, {}})), limits_(limits) {}
    SliceReader(SliceReader&&) noexcept = default;
    SliceReader& operator=(SliceReader&&) = delete;
    /// Subtracts what is not kept from the limits.
    ~SliceReader() {
        limits_.give_back(0, vertices_.capacity() * sizeof(Point2));
        if (stack_.use_count() != 1)
            return;
        limits_.give_back(0, stack_->slices.capacity() * sizeof(Slice));
        for (const Slice& slice : stack_->slices)
            limits_.give_back(0, slice.raw.points.capacity() * sizeof(Point2) +
                                     slice.raw.ends.capacity() * sizeof(RawLayer::Contour));
    }

    /// Handles an element as the parser finds it.
    void start(const ThreeMfElement& element) {
        line_ = element.line;
        if (element.name.space == three_mf::slices)
            static_cast<void>(start(element, element.name.local, at_line(line_)));
    }

    void end(XmlName element) {
        if (element.space == three_mf::slices)
            end(element.local, at_line(line_));
    }

    template <class Element, class Where>
    bool start(const Element& element, std::string_view name, const Where& where) {
        if (same_name(name, "vertex") && in_slice()) {
            constexpr std::array<std::string_view, 2> names = {"x", "y"};
            std::array<double, 2> xy{};
            if (!element.take(names, xy))
                return false;
            add_vertex({xy[0], xy[1]}, where);
            return true;
        }
        constexpr std::array<std::string_view, 1> of_slice = {"ztop"};
        constexpr std::array<std::string_view, 1> of_polygon = {"startv"};
        constexpr std::array<std::string_view, 1> of_segment = {"v2"};
        std::array<std::uint32_t, 1> index{};
        if (same_name(name, "segment") && in_slice() && start_)
            return element.take(of_segment, index) && (add_point(index[0], where) || fail(element, index[0]));
        if (same_name(name, "polygon") && in_slice())
            return element.take(of_polygon, index) &&
                   (start_polygon(index[0], where) || fail(element, index[0]));
        if (!same_name(name, "slice"))
            return element.take(std::array<std::string_view, 0>(), index);
        std::array<double, 1> top{};
        if (!element.take(of_slice, top))
            return false;
        if (start_slice(top[0], where))
            return true;
        element.fail(fmt::format("a slice with ztop = {}", top[0]),
                     fmt::format("it to lie above z = {}", stack_->top()));
        return false;
    }

    template <class Where>
    void end(std::string_view name, const Where& where) {
        if (same_name(name, "polygon") && in_slice())
            end_polygon(where);
    }

    /// Takes the line of the last element.
    void at(std::size_t line) { line_ = line; }

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
        found_.add(later.found_);
        vertices_.swap(later.vertices_);
        line_ = later.line_;
        return true;
    }

    [[nodiscard]] const std::shared_ptr<SliceStack>& stack() const { return stack_; }
    [[nodiscard]] const Findings& found() const { return found_; }
    [[nodiscard]] bool in_polygon() const { return start_.has_value(); }

  private:
    [[nodiscard]] bool in_slice() const { return !stack_->slices.empty(); }
    RawLayer& raw() { return stack_->slices.back().raw; }

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
        if (index >= vertices_.size())
            return false;
        Slice& slice = stack_->slices.back();
        if (slice.text) // this polygon follows the end of its slice
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
            found_.note(FindingKind::returning_chains, where);
        else if (!closed)
            found_.note(FindingKind::open_polylines, where);
        raw().end_contour(closed, 0, limits_, where, found_);
        start_.reset();
    }

    template <class Element>
    bool fail(const Element& element, std::uint32_t index) const {
        element.fail(fmt::format("vertex {}", index),
                     fmt::format("less than {}, the number of vertices of the slice", vertices_.size()));
        return false;
    }

    std::shared_ptr<SliceStack> stack_;
    Findings found_;
    ReadLimits& limits_;
    std::vector<Point2> vertices_;       ///< of the last slice
    std::optional<std::uint32_t> start_; ///< first vertex of the polygon under construction
    std::uint32_t last_ = 0;
    std::size_t line_ = 0; ///< of the last element
};

/// The element whose name a cursor has taken, as SliceReader needs it.
struct PlainElement {
    XmlCursor& cursor;
    std::string_view name;
    XmlTagEnd& end;

    template <std::size_t count, class Values>
    bool take(const std::array<std::string_view, count>& names, Values& values) const {
        if (count == 0 && name != "vertices")
            return false; // its meaning is that of the parser
        end = take_values(cursor, names, values);
        return end != XmlTagEnd::none;
    }
    /// The parser reports what is wrong.
    void fail(std::string_view, std::string_view) const {}
};

/// Scans slices up to the first one at or after `limit`, to the end of the stack, or to a tag that is not
/// plain. Calls done(begin of the slice) after each slice.
template <class Done>
void scan_slices(XmlCursor& cursor, std::size_t limit, std::string_view before, SliceReader& reader,
                 LineCounter& lines, const Done& done) {
    std::size_t slice = 0;
    std::size_t last = cursor.position();
    const auto where = [&] {
        return fmt::format("line {}", lines.line(last));
    };
    cursor.scan(
        limit,
        [&](std::string_view name, std::size_t tag) {
            XmlTagEnd end = XmlTagEnd::none;
            if (name.size() < before.size() || !same_name({name.data(), before.size()}, before))
                return end;
            const std::string_view local(name.data() + before.size(), name.size() - before.size());
            if (cursor.open().empty() != same_name(local, "slice")) // else these could not be read again
                return end;
            const std::size_t earlier = std::exchange(last, tag);
            if (!reader.start(PlainElement{cursor, local, end}, local, where)) {
                last = earlier;
                return XmlTagEnd::none;
            }
            slice = cursor.open().empty() ? tag : slice;
            return end;
        },
        [&](std::string_view name) {
            reader.end(name.substr(before.size()), where);
            if (cursor.open().empty())
                done(slice);
        });
    if (!cursor.open().empty())
        reader.at(lines.line(last));
}

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
            handlers.many = tag_;
            handlers.skim = [this](XmlCursor& cursor) {
                read_slices(cursor);
            };
        }
        parse_part(part_, handlers, executor_);
        append_to(found_, model_.warnings);
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
        const auto space = element.spaces.find(std::string(prefix_.value_or("")));
        is_plain_ = space != element.spaces.end() && space->second == three_mf::slices;
        // One worker reads all slices where they are, without a pass ahead.
        in_pieces_ = executor_.workers() > 1 &&
                     std::none_of(element.spaces.begin(), element.spaces.end(), [](const auto& declared) {
                         return declared.second.find_first_of("&<\"\t\r\n") != std::string::npos;
                     });
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
            found_.add(slices_->found());
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
        std::size_t end = std::string_view::npos; ///< where the next piece begins; npos after an error
    };

    /// Reads the slices from the cursor to the end of the stack, or to one that is not plain.
    void read_slices(XmlCursor& cursor) {
        if (!is_plain_ || !slices_ || depth_ != stack_depth_ || slices_->in_polygon())
            return;
        if (!limits_.in_memory() && !again_)
            again_ = std::make_shared<const SliceText>(SliceText{
                part_, text_.rfind('<'), {cursor.prefixes().begin(), cursor.prefixes().end()}, before_});
        if (in_pieces_)
            read_pieces_of_stack(cursor);
        else
            scan(cursor, text_.size(), *slices_, lines_);
        depth_ += cursor.open().size();
    }

    void scan(XmlCursor& cursor, std::size_t limit, SliceReader& slices, LineCounter& lines) {
        scan_slices(cursor, limit, before_, slices, lines, [&](std::size_t slice) {
            if (again_)
                slices.drop_contents(again_, slice);
            executor_.check_cancelled();
        });
    }

    void read_pieces_of_stack(XmlCursor& cursor) {
        const std::uint64_t first_line = lines_.line(cursor.position());
        read_sibling_pieces(
            text_, cursor.position(), first_line, executor_,
            [&](std::size_t begin, std::size_t limit, std::uint64_t line) {
                return read_piece(begin, limit, line);
            },
            [&](Piece&& piece, std::uint64_t line) {
                in_pieces_ = piece.end != std::string_view::npos && slices_->append(std::move(piece.slices));
                if (in_pieces_) {
                    cursor.move_to(piece.end, line - first_line);
                    lines_ = LineCounter(text_, piece.end, line);
                }
                return in_pieces_;
            });
    }

    /// Reads slices from `begin` on, in line `line`, to the first one at or after `limit`, or to the end of
    /// the stack.
    Piece read_piece(std::size_t begin, std::size_t limit, std::uint64_t line) {
        executor_.check_cancelled();
        Piece piece{.slices = SliceReader(-std::numeric_limits<double>::infinity(), limits_)};
        LineCounter lines(text_, begin, line);
        std::size_t depth = 0;
        const ThreeMfHandlers handlers{.start =
                                           [&](const ThreeMfElement& element) {
                                               if (!is_of_slices(element.name))
                                                   element.fail("an element that is not in a slice",
                                                                "slices");
                                               ++depth;
                                               piece.slices.start(element);
                                           },
                                       .end =
                                           [&](XmlName name) {
                                               --depth;
                                               piece.slices.end(name);
                                           },
                                       .many = tag_,
                                       .skim =
                                           [&](XmlCursor& cursor) {
                                               if (depth == 0 && !piece.slices.in_polygon())
                                                   scan(cursor, limit, piece.slices, lines);
                                               depth += cursor.open().size();
                                           }};
        try {
            piece.end = parse_part_elements(part_, begin, limit, before_ + "slicestack", *spaces_, line,
                                            handlers, executor_);
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::input)
                throw;
        }
        return piece;
    }

    /// Returns whether an element in a stack has no meaning outside of slices.
    static bool is_of_slices(XmlName name) {
        return name.space == three_mf::slices ? name.local != "slicestack" && name.local != "sliceref"
                                              : name.space != three_mf::core;
    }

    const ByteSource& part_;
    std::string_view text_;
    std::optional<std::string_view> prefix_ = slice_prefix(text_);
    std::string before_ = prefix_.value_or("").empty() ? std::string() : fmt::format("{}:", *prefix_);
    std::string tag_ = fmt::format("<{}slice", before_);
    const FindSliceStack& find_;
    ReadLimits& limits_;
    Executor& executor_;
    LineCounter lines_{text_};
    const ThreeMfSpaces* spaces_ = nullptr;
    std::shared_ptr<const SliceText> again_; ///< null if layers are kept in memory
    bool is_plain_ = false;                  ///< the root element gives the prefix to slices
    bool in_pieces_ = false;
    std::size_t depth_ = 0;
    std::size_t stack_depth_ = 0;
    std::optional<SliceReader> slices_; ///< of the stack under construction
    Findings found_;
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
    XmlCursor cursor(text->part.text(), raw.begin, text->last_tag, text->prefixes);
    scan_slices(cursor, raw.begin + 1, text->before, slices, lines, [](std::size_t) {});
    assert(slices.stack()->slices.size() == 1);
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
