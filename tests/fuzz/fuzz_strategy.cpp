// Any bytes as a strategy file: an error that names a line, or a strategy that is right, is written so that
// it is read as the same again, and scans a small layer, or meets a limit.

#include "app/strategy_file.hpp"
#include "promises.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace lamella;
using fuzz::require;

/// Strategies are read from files.
ScanStrategy read(std::string_view text) {
    struct File {
        int number = memfd_create("strategy", MFD_CLOEXEC);
        File() = default;
        File(const File&) = delete;
        File& operator=(const File&) = delete;
        ~File() { close(number); }
    } const file;
    require(write(file.number, text.data(), text.size()) == static_cast<ssize_t>(text.size()));
    return app::read_strategy("/proc/self/fd/" + std::to_string(file.number));
}

/// A square of a millimetre with a hole.
Layer small_layer(std::uint64_t index) {
    LayerBuilder builder;
    for (const Point2& p : {Point2{0, 0}, Point2{1, 0}, Point2{1, 1}, Point2{0, 1}})
        builder.add_point(p);
    builder.end_contour(true);
    for (const Point2& p : {Point2{0.4, 0.4}, Point2{0.4, 0.6}, Point2{0.6, 0.6}, Point2{0.6, 0.4}})
        builder.add_point(p);
    builder.end_contour(true);
    const double bottom = 0.03 * static_cast<double>(index);
    return builder.finish(index, bottom + 0.015, bottom, bottom + 0.03);
}

/// Lines of up to the limit of `scan` take minutes; more than that are refused at once.
bool takes_long(const HatchRule& rule) {
    constexpr double few = 1e4;
    const double pieces = (1 / rule.distance + 1) * (1 / rule.cell + 1);
    return pieces > few;
}

void scan_and_check(const ScanStrategy& strategy) {
    for (const HatchRule* const rule :
         {&strategy.hatch, &strategy.upskin.hatch, &strategy.downskin.hatch, &strategy.support.hatch})
        if (takes_long(*rule))
            return;
    const Layer layer = small_layer(3);
    const std::vector<ScanLayer> beside{small_layer(2)};
    try {
        for (const ScannedLayer& scanned :
             {scan(layer, beside, beside, strategy), scan_support(layer, strategy)})
            for (std::size_t i = 0; i < scanned.vectors.parts(); ++i)
                fuzz::require_whole(scanned.vectors.polylines[i], scanned.vectors.hatches[i].span());
    } catch (const Error& error) {
        require(error.kind() == ErrorKind::limit);
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const ScanStrategy strategy = read({reinterpret_cast<const char*>(data), size});
        check_strategy(strategy);
        const std::string text = strategy_text(strategy);
        require(strategy_text(read(text)) == text);
        scan_and_check(strategy);
    } catch (const Error& error) {
        require(error.kind() == ErrorKind::usage);
    }
    return 0;
}
