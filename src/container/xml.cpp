#include "container/xml.hpp"

#include "lamella/core/error.hpp"

#include <expat.h>
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <memory>

namespace lamella {

namespace {

constexpr int deepest = 256;

/// The state of one parse. Exceptions must not pass through the C library: they are kept and thrown behind
/// it.
struct Parse {
    const XmlHandlers& handlers;
    const std::string& name;
    XML_Parser parser = nullptr;
    int depth = 0;
    std::exception_ptr error = nullptr;

    template <class Call>
    void guarded(const Call& call) {
        if (error)
            return;
        try {
            call();
        } catch (...) {
            error = std::current_exception();
            XML_StopParser(parser, XML_FALSE);
        }
    }

    [[noreturn]] void fail(const std::string& found) const {
        throw Error(ErrorKind::input,
                    fmt::format("{}, line {}: {}", name, XML_GetCurrentLineNumber(parser), found));
    }
};

void on_start(void* data, const XML_Char* name, const XML_Char** attributes) {
    auto& parse = *static_cast<Parse*>(data);
    parse.guarded([&] {
        if (++parse.depth > deepest)
            parse.fail(fmt::format("found elements nested deeper than {}; no slice file is", deepest));
        parse.handlers.start(name, XmlAttributes(attributes), XML_GetCurrentLineNumber(parse.parser));
    });
}

void on_end(void* data, const XML_Char* name) {
    auto& parse = *static_cast<Parse*>(data);
    parse.guarded([&] {
        --parse.depth;
        parse.handlers.end(name);
    });
}

void on_doctype(void* data, const XML_Char*, const XML_Char*, const XML_Char*, int has_internal_subset) {
    auto& parse = *static_cast<Parse*>(data);
    parse.guarded([&] {
        // Drawing programs write a reference to the public definition of SVG, which is harmless as nothing is
        // fetched.
        if (has_internal_subset != 0)
            parse.fail("found a document type with definitions of its own; such files are not read");
    });
}

} // namespace

std::string_view XmlAttributes::find(std::string_view name) const noexcept {
    for (const char** pair = pairs_; *pair != nullptr; pair += 2)
        if (name == *pair)
            return pair[1];
    return {};
}

void parse_xml(std::string_view bytes, const std::string& name, const XmlHandlers& handlers) {
    const std::unique_ptr<std::remove_pointer_t<XML_Parser>, decltype(&XML_ParserFree)> parser(
        XML_ParserCreate(nullptr), &XML_ParserFree);
    if (!parser)
        throw std::bad_alloc();
    Parse parse{handlers, name, parser.get()};
    XML_SetUserData(parser.get(), &parse);
    XML_SetElementHandler(parser.get(), on_start, on_end);
    XML_SetStartDoctypeDeclHandler(parser.get(), on_doctype);

    constexpr std::size_t piece = std::size_t{4} << 20;
    for (std::size_t at = 0;; at += piece) {
        const std::string_view part = bytes.substr(std::min(at, bytes.size()), piece);
        const bool last = at + piece >= bytes.size();
        const XML_Status status =
            XML_Parse(parser.get(), part.data(), static_cast<int>(part.size()), last ? XML_TRUE : XML_FALSE);
        if (parse.error)
            std::rethrow_exception(parse.error);
        if (status != XML_STATUS_OK)
            parse.fail(fmt::format("the XML is broken: {}", XML_ErrorString(XML_GetErrorCode(parser.get()))));
        handlers.progress(part.size());
        if (last)
            return;
    }
}

} // namespace lamella
