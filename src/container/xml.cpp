#include "container/xml.hpp"

#include "lamella/core/error.hpp"

#include "container/text_position.hpp"
#include "core/lower_case.hpp"

#include <expat.h>
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <exception>
#include <map>
#include <memory>
#include <new>
#include <optional>

namespace lamella {

namespace {

constexpr int deepest_element = 256;
constexpr std::size_t most_attributes = 1000;
constexpr std::size_t chunk = std::size_t{1} << 20; // Expat copies it, and keeps room for two
constexpr std::size_t longest_token = std::size_t{64} << 20;
constexpr char namespace_end = '\n'; // Expat's separator between namespace and name; no URI contains it

XmlName split(std::string_view written) noexcept {
    const std::size_t at = written.rfind(namespace_end);
    return at == std::string_view::npos ? XmlName{{}, written}
                                        : XmlName{written.substr(0, at), written.substr(at + 1)};
}

/// Returns whether the declaration of the document spells the encoding "utf8", as some writers do. Expat does
/// not know this name.
bool declares_utf8_without_hyphen(std::string_view bytes) {
    constexpr std::size_t longest_declaration = 200;
    const std::string_view begin = bytes.substr(0, longest_declaration);
    const std::string declaration = lower_case(begin.substr(0, begin.find("?>")));
    const std::size_t at = declaration.find("encoding");
    if (declaration.find("<?xml") == std::string::npos || at == std::string::npos)
        return false;
    const std::size_t quote = declaration.find_first_of("'\"", at);
    return quote != std::string::npos && declaration.compare(quote + 1, 4, "utf8") == 0 &&
           declaration.compare(quote + 5, 1, declaration, quote, 1) == 0;
}

/// Returns the prefixes that attributes may have without being the same as another attribute, ascending.
std::vector<std::string> plain_prefixes(const std::map<std::string, std::string>& spaces) {
    std::vector<std::string> prefixes;
    for (const auto& declared : spaces) {
        const auto same_space = [&](const auto& other) {
            return !other.first.empty() && other.first != declared.first && other.second == declared.second;
        };
        if (!declared.first.empty() && std::none_of(spaces.begin(), spaces.end(), same_space))
            prefixes.push_back(declared.first);
    }
    return prefixes;
}

/// The state of one parse. Exceptions must not pass through the C library: they are stored and rethrown after
/// it returns.
class Parse {
  public:
    Parse(std::string_view bytes, const std::string& name, const XmlHandlers& handlers, const XmlRules& rules)
        : bytes_(bytes), name_(name), handlers_(handlers), rules_(rules),
          parser_(rules.namespaces ? XML_ParserCreateNS(nullptr, namespace_end) : XML_ParserCreate(nullptr),
                  &XML_ParserFree) {
        if (!parser_)
            throw std::bad_alloc();
        if (declares_utf8_without_hyphen(bytes))
            XML_SetEncoding(parser_.get(), "UTF-8");
        XML_SetUserData(parser_.get(), this);
        XML_SetElementHandler(parser_.get(), on_start, on_end);
        XML_SetStartDoctypeDeclHandler(parser_.get(), on_doctype);
        if (handlers.text)
            XML_SetCharacterDataHandler(parser_.get(), on_text);
        if (handlers.declare || handlers.skim)
            XML_SetNamespaceDeclHandler(parser_.get(), on_namespace, on_namespace_end);
        if (rules.utf8_only)
            XML_SetXmlDeclHandler(parser_.get(), on_declaration);
    }

    void run() {
        if (rules_.utf8_only && (bytes_.starts_with("\xff\xfe") || bytes_.starts_with("\xfe\xff")))
            fail("found UTF-16, expected UTF-8");
        skim_through(bytes_.size());
        feed(bytes_.size(), true);
    }

    /// See parse_xml_elements.
    std::size_t run_between(std::size_t begin, std::size_t limit, std::string_view parent) {
        at_ = reported_ = begin;
        limit_ = limit;
        enter(parent);
        skim_through(limit);
        constexpr std::size_t step = std::size_t{1} << 14;
        for (std::size_t to = std::max(limit, at_ + step); !stop_; to = at_ + step) {
            if (at_ == bytes_.size())
                fail("the document ends within an element");
            feed(std::min(to, bytes_.size()), false);
        }
        return *stop_;
    }

  private:
    /// Callback of Expat: call(parse), unless a call has thrown before.
    template <class Call>
    static void guarded(void* data, const Call& call) {
        Parse& parse = *static_cast<Parse*>(data);
        if (parse.error_ || parse.stop_)
            return;
        try {
            call(parse);
        } catch (...) {
            parse.error_ = std::current_exception();
            XML_StopParser(parse.parser_.get(), XML_FALSE);
        }
    }

    [[noreturn]] void fail(const std::string& found) const {
        throw Error(ErrorKind::input, fmt::format("{}, line {}: {}", name_, line(), found));
    }

    [[nodiscard]] std::size_t line() const {
        return XML_GetCurrentLineNumber(parser_.get()) + skimmed_lines_;
    }

    static void on_start(void* data, const XML_Char* name, const XML_Char** attributes) {
        guarded(data, [&](Parse& parse) {
            if (++parse.depth_ > deepest_element)
                parse.fail(fmt::format("found elements nested deeper than {}; no file of this kind is",
                                       deepest_element));
            if (attributes[0] != nullptr &&
                static_cast<std::size_t>(XML_GetSpecifiedAttributeCount(parse.parser_.get())) / 2 >
                    most_attributes)
                parse.fail(fmt::format("found an element of more than {} attributes", most_attributes));
            parse.declared_ = 0;
            if (parse.depth_ == 1)
                parse.prefixes_ = plain_prefixes(parse.spaces_);
            if (parse.enters_)
                return;
            if (parse.depth_ == 2 && parse.position() >= parse.limit_)
                return parse.stop();
            if (parse.depth_ == 2 && parse.handlers_.element)
                parse.handlers_.element(parse.position());
            parse.note_tag();
            parse.handlers_.start(split(name), XmlAttributes(attributes), parse.line());
        });
    }

    static void on_end(void* data, const XML_Char* name) {
        guarded(data, [&](Parse& parse) {
            if (--parse.depth_ == 0 && parse.limit_ != whole_document)
                return parse.stop();
            parse.note_tag();
            parse.handlers_.end(split(name));
        });
    }

    static void on_text(void* data, const XML_Char* text, int size) {
        guarded(data, [&](Parse& parse) { parse.handlers_.text({text, static_cast<std::size_t>(size)}); });
    }

    static void on_namespace(void* data, const XML_Char* prefix, const XML_Char* space) {
        guarded(data, [&](Parse& parse) {
            if (++parse.declared_ > most_attributes)
                parse.fail(
                    fmt::format("found an element that declares more than {} namespaces", most_attributes));
            if (parse.depth_ != 0) {
                ++parse.inner_spaces_;
                return;
            }
            const auto& [known, uri] =
                *parse.spaces_.emplace(prefix == nullptr ? "" : prefix, space == nullptr ? "" : space).first;
            if (parse.handlers_.declare)
                parse.handlers_.declare(known, uri);
        });
    }

    static void on_namespace_end(void* data, const XML_Char*) {
        guarded(data, [](Parse& parse) {
            if (parse.depth_ > 0)
                --parse.inner_spaces_;
        });
    }

    static void on_doctype(void* data, const XML_Char*, const XML_Char*, const XML_Char*,
                           int has_internal_subset) {
        guarded(data, [&](Parse& parse) {
            if (parse.rules_.no_document_type)
                parse.fail("found a document type (<!DOCTYPE ...>), which files of this kind must not have");
            // Drawing programs write a reference to the public definition of SVG. It is harmless, because
            // nothing is fetched.
            if (has_internal_subset != 0)
                parse.fail("found a document type with definitions of its own; such files are not read");
        });
    }

    static void on_declaration(void* data, const XML_Char*, const XML_Char* encoding, int) {
        guarded(data, [&](Parse& parse) {
            if (encoding == nullptr)
                return;
            const std::string lower = lower_case(encoding);
            if (lower != "utf-8" && lower != "utf8")
                parse.fail(fmt::format("found encoding '{}', expected UTF-8", printable(encoding, 40)));
        });
    }

    /// Returns the offset of the current tag in the document.
    [[nodiscard]] std::size_t position() const {
        return static_cast<std::size_t>(XML_GetCurrentByteIndex(parser_.get()) + not_fed_);
    }

    /// Ends parsing before the current tag.
    void stop() {
        stop_ = position();
        XML_StopParser(parser_.get(), XML_FALSE);
    }

    /// Feeds the parser start tags of which the handlers do not learn, and continues at `at_`.
    void enter(std::string_view tags) {
        enters_ = true;
        if (XML_Parse(parser_.get(), tags.data(), static_cast<int>(tags.size()), XML_FALSE) != XML_STATUS_OK)
            fail("the element around has no usable name");
        enters_ = false;
        fed_ += static_cast<XML_Index>(tags.size());
        parsed_ = last_tag_end_ = fed_;
        not_fed_ = static_cast<XML_Index>(at_) - fed_;
    }

    /// Stores where a tag ends if skimming is in use.
    void note_tag() {
        if (handlers_.skim)
            last_tag_end_ = XML_GetCurrentByteIndex(parser_.get()) + XML_GetCurrentByteCount(parser_.get());
    }

    /// Feeds the parser the bytes up to `end`, or somewhat more if `end` is within a token.
    void feed(std::size_t end, bool last) {
        do {
            const std::string_view part =
                bytes_.substr(at_, waiting() == 0 ? std::min(end - at_, chunk) : more_of_token());
            if (waiting() != 0 && handlers_.hold)
                handlers_.hold(waiting() + part.size());
            at_ += part.size();
            fed_ += static_cast<XML_Index>(part.size());
            const XML_Status status = XML_Parse(parser_.get(), part.data(), static_cast<int>(part.size()),
                                                last && at_ == end ? XML_TRUE : XML_FALSE);
            if (error_)
                std::rethrow_exception(error_);
            if (stop_)
                return;
            if (status != XML_STATUS_OK) {
                const XML_Error code = XML_GetErrorCode(parser_.get());
                if (code == XML_ERROR_NO_MEMORY)
                    throw std::bad_alloc();
                fail(fmt::format("the XML is broken: {}", XML_ErrorString(code)));
            }
            parsed_ = std::max(parsed_, XML_GetCurrentByteIndex(parser_.get())); // -1 if Expat does not know
            if (waiting() >= longest_token)
                fail(fmt::format("found a tag, text or comment longer than {} MB", longest_token >> 20));
            report_progress(at_);
        } while (at_ < end);
    }

    /// Returns the number of bytes of an incomplete token that the parser holds.
    [[nodiscard]] std::size_t waiting() const { return static_cast<std::size_t>(fed_ - parsed_); }

    /// Returns the number of further bytes of an incomplete token to feed: at least as many as were already
    /// fed. Expat scans the token from its start each time; newer versions (2.6, and older ones with its
    /// security patches) wait until they have twice as many bytes. The last step ends exactly at the longest
    /// permitted size: a token that is then incomplete is refused, for any version of Expat.
    [[nodiscard]] std::size_t more_of_token() const {
        constexpr std::size_t first_step = std::size_t{1} << 16;
        std::size_t enough = longest_token;
        while (enough / 2 >= std::max(2 * waiting(), first_step))
            enough /= 2;
        return enough - waiting();
    }

    void report_progress(std::size_t position) {
        if (handlers_.progress && (position - reported_ >= chunk || position == bytes_.size())) {
            handlers_.progress(position - reported_);
            reported_ = position;
        }
    }

    /// Feeds the document, except skimmed elements, up to the end of the last skimmed elements before
    /// `limit`.
    void skim_through(std::size_t limit) {
        if (!handlers_.skim)
            return;
        const std::size_t last_tag = bytes_.rfind('<');
        std::size_t from = at_;
        // A call of `skim` without success costs time, so the distance to the next call doubles.
        std::size_t patience = std::size_t{1} << 16;
        while (!stop_) {
            const std::size_t tag = find_tag(from, limit);
            if (tag == limit)
                return;
            std::size_t blanks = tag;
            while (blanks > at_ && is_blank(bytes_[blanks - 1]))
                --blanks;
            if (blanks > at_)
                feed(blanks, false);
            if (at_ > blanks) { // the tag is inside a longer token
                from = at_;
                continue;
            }
            XmlCursor cursor(bytes_, tag, last_tag, prefixes_);
            if (last_tag_end_ == fed_ && inner_spaces_ == 0)
                handlers_.skim(cursor);
            if (cursor.position() > tag)
                skip(tag, cursor);
            from = std::max(at_, tag);
            if (cursor.position() == tag || !cursor.open().empty() || bytes_.substr(at_, 2) != "</") {
                from += patience;
                patience *= 2;
            }
        }
    }

    /// Continues where the cursor is, which has read from `tag` on.
    void skip(std::size_t tag, const XmlCursor& cursor) {
        const std::size_t bytes = cursor.position() - tag;
        skimmed_lines_ += line_at(bytes_.substr(at_), tag - at_) - 1;
        skimmed_lines_ += cursor.lines() ? *cursor.lines() : line_at(bytes_.substr(tag), bytes) - 1;
        at_ = cursor.position();
        std::string tags;
        for (const std::string_view name : cursor.open())
            tags += fmt::format("<{}>", name);
        enter(tags);
        report_progress(at_);
    }

    /// Returns the nearest tag of `many` before `limit`, or `limit`. All of them are searched for in one
    /// window after the other, because one of them may be far away.
    [[nodiscard]] std::size_t find_tag(std::size_t from, std::size_t limit) const {
        constexpr std::size_t window = std::size_t{1} << 14;
        for (std::size_t begin = from; begin < limit; begin += window) {
            const std::size_t end = std::min(begin + window, limit);
            std::size_t nearest = end;
            for (const std::string_view tag : handlers_.many)
                nearest = std::min(nearest, find_tag(tag, begin, nearest));
            if (nearest < end)
                return nearest;
        }
        return limit;
    }

    /// Returns where a tag begins in [from, limit), or `limit`. "<triangle" does not match "<triangles".
    [[nodiscard]] std::size_t find_tag(std::string_view tag, std::size_t from, std::size_t limit) const {
        const std::string_view text = bytes_.substr(0, limit - 1 + tag.size());
        for (std::size_t at = text.find(tag, from); at != std::string_view::npos; at = text.find(tag, at + 1))
            if (at + tag.size() == bytes_.size() || ends_name(bytes_[at + tag.size()]))
                return at;
        return limit;
    }

    static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
    static bool ends_name(char c) { return is_blank(c) || c == '>' || c == '/'; }

    std::string_view bytes_;
    const std::string& name_;
    const XmlHandlers& handlers_;
    const XmlRules& rules_;
    std::unique_ptr<std::remove_pointer_t<XML_Parser>, decltype(&XML_ParserFree)> parser_;
    std::exception_ptr error_ = nullptr;
    int depth_ = 0;
    std::size_t declared_ = 0;    ///< namespaces declared by the next element
    std::size_t at_ = 0;          ///< offset in the document
    XML_Index fed_ = 0;           ///< bytes fed to the parser
    XML_Index parsed_ = 0;        ///< bytes fed that the parser has consumed
    XML_Index last_tag_end_ = -1; ///< counts bytes fed
    XML_Index not_fed_ = 0;       ///< offset in the document minus that in the bytes fed
    static constexpr std::size_t whole_document = std::string_view::npos;
    std::size_t limit_ = whole_document; ///< for elements of a parent: parsing ends at the first from here on
    std::optional<std::size_t> stop_;    ///< where it ended
    bool enters_ = false;                ///< in enter()
    std::map<std::string, std::string> spaces_; ///< namespaces that the root declares, by prefix
    std::vector<std::string> prefixes_;         ///< of plain attributes
    std::size_t inner_spaces_ = 0;              ///< namespaces that elements within the root declare
    std::size_t skimmed_lines_ = 0;
    std::size_t reported_ = 0;
};

} // namespace

std::string_view XmlAttributes::find(std::string_view local) const noexcept {
    for (const char** pair = pairs_; *pair != nullptr; pair += 2)
        if (local == *pair)
            return pair[1];
    return {};
}

std::string_view XmlAttributes::find(XmlName name) const noexcept {
    for (const char** pair = pairs_; *pair != nullptr; pair += 2)
        if (split(*pair) == name)
            return pair[1];
    return {};
}

std::string_view trimmed(std::string_view text) noexcept {
    constexpr std::string_view blanks = " \t\r\n";
    const std::size_t first = text.find_first_not_of(blanks);
    return first == std::string_view::npos ? std::string_view()
                                           : text.substr(first, text.find_last_not_of(blanks) + 1 - first);
}

void parse_xml(std::string_view bytes, const std::string& name, const XmlHandlers& handlers,
               const XmlRules& rules) {
    Parse(bytes, name, handlers, rules).run();
}

std::size_t parse_xml_elements(std::string_view document, std::size_t begin, std::size_t limit,
                               std::string_view parent, const std::string& name, const XmlHandlers& handlers,
                               const XmlRules& rules) {
    return Parse(document, name, handlers, rules).run_between(begin, limit, parent);
}

} // namespace lamella
