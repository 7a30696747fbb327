#include "failure.hpp"

#include "lamella/core/error.hpp"

#include <fmt/format.h>

#include <array>
#include <new>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace lamella::app {
namespace {

/// A field name in texts of the library, such as `max_memory`, and the corresponding option.
struct FieldOption {
    std::string_view field;
    std::string_view option;
};

constexpr std::array field_options{
    FieldOption{"`accepted_mm2`", "accepted_mm2"},
    FieldOption{"`adaptive`", "--adaptive"},
    FieldOption{"`close_gaps_mm`", "--close-gaps"},
    FieldOption{"`drop_duplicates`", "--drop-duplicates"},
    FieldOption{"`fill`", "--fill"},
    FieldOption{"`format`", "--format"},
    FieldOption{"`include`", "--include"},
    FieldOption{"`inspect`", "--inspect"},
    FieldOption{"`max_memory`", "--max-memory"},
    FieldOption{"`max_triangles`", "--max-triangles"},
    FieldOption{"`min_area_mm2`", "--min-area"},
    FieldOption{"`offset_mm`", "--offset"},
    FieldOption{"`orient`", "--orient"},
    FieldOption{"`display_mm`", "--display-size"},
    FieldOption{"`pixels`", "--resolution"},
    FieldOption{"`placement`", "--translate"},
    FieldOption{"`printer`", "--printer"},
    FieldOption{"`snap_mm`", "--snap"},
    FieldOption{"`strict`", "--strict"},
    FieldOption{"`threads`", "--threads"},
    FieldOption{"`unite_parts`", "--unite-parts"},
    FieldOption{"`weld_tolerance_mm`", "--weld-tolerance"},
    // Fields of a strategy. An option changes the field in all rules at once, but an error names the first
    // field that was checked. The cell must suit the overlap of each rule separately.
    FieldOption{"`contours.beam_offset`", "--beam-offset"},
    FieldOption{"`contours.count`", "--contours"},
    FieldOption{"`contours.distance`", "--contour-distance"},
    FieldOption{"`hatch.angle_degrees`", "--hatch-angle"},
    FieldOption{"`hatch.border`", "--hatch-border"},
    FieldOption{"`hatch.cell`", "--cell-size"},
    FieldOption{"`upskin.hatch.cell`", "--cell-size"},
    FieldOption{"`downskin.hatch.cell`", "--cell-size"},
    FieldOption{"`hatch.distance`", "--hatch-distance"},
    FieldOption{"`hatch.shortest`", "--shortest"},
    FieldOption{"`hatch.turn_degrees`", "--hatch-turn"},
    FieldOption{"`upskin.layers`", "--skin-layers"},
};

Failure failure(ErrorKind kind, std::string text) {
    switch (kind) {
    case ErrorKind::usage:
        return {"usage", 2, std::move(text)};
    case ErrorKind::input:
        return {"input", 3, std::move(text)};
    case ErrorKind::defect:
        return {"defect", 4, std::move(text)};
    case ErrorKind::limit:
        return {"limit", limit_exit_code, std::move(text)};
    case ErrorKind::output:
        return {"output", 6, std::move(text)};
    case ErrorKind::cancelled:
        return {"cancelled", 130, std::move(text)};
    case ErrorKind::internal:
        break;
    }
    return {"internal", 1, fmt::format("{} (please report this)", text)};
}

} // namespace

std::string with_options(std::string text) {
    for (const auto& [field, option] : field_options)
        for (auto at = text.find(field); at != std::string::npos; at = text.find(field, at))
            text.replace(at, field.size(), option);
    return text;
}

Failure failure_of(const std::exception_ptr& error) {
    try {
        std::rethrow_exception(error);
    } catch (const Error& known) {
        return failure(known.kind(), with_options(known.what()));
    } catch (const std::bad_alloc&) {
        return failure(ErrorKind::limit, std::string(out_of_memory));
    } catch (const std::system_error& refused) {
        for (const std::errc limit :
             {std::errc::resource_unavailable_try_again, std::errc::not_enough_memory,
              std::errc::too_many_files_open, std::errc::too_many_files_open_in_system})
            if (refused.code() == limit)
                return failure(
                    ErrorKind::limit,
                    fmt::format("the system gives no further threads or files: {}; raise the limits "
                                "of this process (see ulimit)",
                                refused.code().message()));
        return failure(ErrorKind::internal, refused.what());
    } catch (const std::exception& unknown) {
        return failure(ErrorKind::internal, unknown.what());
    }
}

Failure failure_of_process(const ProcessEnd& end, const std::string& path) {
    using Kind = ProcessEnd::Kind;
    if (end.kind == Kind::exited && end.exit_code == limit_exit_code)
        return failure(ErrorKind::limit, fmt::format("{}: stopped by --timeout while it was stuck", path));
    if (end.kind == Kind::exited && end.exit_code == 130)
        return failure(ErrorKind::cancelled, "cancelled");
    if (end.kind == Kind::time_is_up)
        return failure(
            ErrorKind::limit,
            fmt::format("{}: the processor time that a process may take is used up (see ulimit -t)", path));
    if (end.kind == Kind::killed)
        return failure(
            ErrorKind::limit,
            fmt::format("{}: the process that worked on it was killed, as systems do with what takes "
                        "too much memory",
                        path));
    return {"crash", 1,
            fmt::format("{}: the process that worked on it crashed ({}); please report this with the file",
                        path, end.reason)};
}

} // namespace lamella::app
