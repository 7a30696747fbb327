// Slice files of all formats: any way of reading gives the same layers, warnings and errors, and no bytes do
// more harm than an error.

#include "fixtures/expect_error.hpp"
#include "fixtures/layer_outcome.hpp"
#include "fixtures/random_layers.hpp"
#include "fixtures/rounds.hpp"
#include "slices/common_layer_files.hpp"
#include "slices/images/resin_jobs.hpp"
#include "slices/svg_files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <ostream>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::hostile_layers {
namespace {

using test::layer_outcome;
using test::same_outcome;

struct LayerSample {
    std::string name; ///< of the format, and of what it has
    std::function<std::string()> bytes;
};

/// Prints the name if a test fails.
void PrintTo(const LayerSample& sample, std::ostream* out) {
    *out << sample.name;
}

/// Returns parts with the vectors of these, contours and hatch lines each with an exposure of their own.
std::vector<LayerPart> exposed(const std::vector<LayerPart>& parts) {
    std::vector<LayerPart> all;
    for (const LayerPart& part : parts)
        for (const VectorKind kind : {VectorKind::contour, VectorKind::hatch}) {
            const bool hatch = kind == VectorKind::hatch;
            LayerPart& one = all.emplace_back(part);
            one.exposure = {.part = all.size() <= 2 ? "left" : "right",
                            .region = ScanRegion::core,
                            .kind = kind,
                            .contour = hatch ? 0U : 1U,
                            .parameters = {}};
            for (Layer& layer : one.layers)
                if (hatch)
                    layer = LayerBuilder().finish(layer.index, layer.z, layer.bottom, layer.top);
            if (!hatch)
                one.hatches.clear();
        }
    return all;
}

constexpr std::string_view formats[] = {"cli",  "cli-ascii", "svg", "slc", "3mf",
                                        "json", "npz",       "ilt", "ovf", "3mf-toolpath"};

/// Those of images, whose files the printer's previews make large.
constexpr std::string_view image_formats[] = {"png-zip", "sl1",      "goo",          "ctb",
                                              "cbddlp",  "anycubic", "chitubox-zip", "nanodlp"};

/// Small files, all of whose bytes a test can change.
std::vector<LayerSample> small_samples() {
    std::vector<LayerSample> samples;
    for (const std::string_view format : formats)
        samples.push_back({std::string(format), [format] {
                               return test::layer_bytes(format, test::random_parts(5, 2, 3));
                           }});
    for (const std::string_view format : {"ilt", "ovf", "3mf-toolpath"})
        samples.push_back({std::string(format) + " of scan vectors", [format] {
                               return test::layer_bytes(format, exposed(test::random_parts(11, 2, 4)));
                           }});
    for (const std::string_view format : image_formats)
        samples.push_back({std::string(format), [format] {
                               ResinPrinter printer = tiny_printer;
                               printer.bottom_layers = 3; // as all formats can have them
                               return job_of(format, squares(4), {.printer = &printer});
                           }});
    using namespace common_layer_reading;
    samples.push_back({"cli-ascii by hand", [] {
                           return ascii(ring);
                       }});
    samples.push_back({"cli of long numbers", [] {
                           return binary(long_ring);
                       }});
    samples.push_back({"cli of short numbers", [] {
                           return binary(short_ring);
                       }});
    samples.push_back({"svg of Slic3r", [] {
                           return svg_files::svg(
                               "<g id=\"layer0\" slic3r:z=\"0.5\" slic3r:slice-z=\"0.25\">" +
                               svg_files::square + svg_files::hole + "</g>\n");
                       }});
    return samples;
}

/// Files of several pieces.
std::vector<LayerSample> large_samples() {
    std::vector<LayerSample> samples;
    for (const std::string_view format : formats)
        samples.push_back({std::string(format), [format] {
                               return test::layer_bytes(format, test::random_parts(9, 2, 900));
                           }});
    return samples;
}

std::string test_name(const testing::TestParamInfo<LayerSample>& sample) {
    std::string name = sample.param.name;
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == '-' || c == ' '; }, '_');
    return name;
}

class HostileLayers : public testing::TestWithParam<LayerSample> {
  protected:
    /// Expects an input error, or sound layers, whether they are in memory or not. Returns the outcome.
    static std::string expect_harmless(std::string_view bytes) {
        std::string held = layer_outcome(bytes);
        EXPECT_TRUE(same_outcome(layer_outcome(bytes, {.kept = KeptPlanes::none}), held));
        return held;
    }

    static std::size_t planes_of(std::string_view outcome) {
        std::size_t planes = 0;
        for (std::size_t at = outcome.find(" points, "); at != std::string_view::npos; ++planes)
            at = outcome.find(" points, ", at + 1);
        return planes;
    }
};

INSTANTIATE_TEST_SUITE_P(Files, HostileLayers, testing::ValuesIn(small_samples()), test_name);

TEST_P(HostileLayers, AreReadWhole) {
    const std::string outcome = expect_harmless(GetParam().bytes());
    EXPECT_FALSE(outcome.starts_with("error")) << outcome;
}

TEST_P(HostileLayers, ThatAreTruncatedAreErrorsOrHaveLess) {
    const std::string bytes = GetParam().bytes();
    const std::size_t whole = planes_of(expect_harmless(bytes));
    const std::size_t step = std::max<std::size_t>(bytes.size() > 8000 ? 7 : 1, bytes.size() / 2000);
    for (std::size_t size = 1; size < bytes.size() && !HasFailure(); size += step * test::slowness)
        EXPECT_LE(planes_of(expect_harmless(std::string_view(bytes).substr(0, size))), whole + 1);
}

TEST_P(HostileLayers, WithChangedBytesAreErrorsOrOtherLayers) {
    const std::string bytes = GetParam().bytes();
    std::mt19937_64 random(11);
    for (int round = 0; round < test::rounds_within_reason(3000) && !HasFailure(); ++round) {
        std::string changed = bytes;
        // Some of them near the end, where tables are.
        const std::size_t from =
            round % 3 != 0 ? 0 : bytes.size() - std::min<std::size_t>(bytes.size(), 1500);
        for (std::uint64_t k = random() % 4 + 1; k > 0; --k)
            changed[from + random() % (changed.size() - from)] =
                static_cast<char>(random() % 4 == 0 ? 0xFF : random());
        static_cast<void>(expect_harmless(changed));
    }
}

TEST(HostileImages, AreTheSameForAnyNumberOfThreads) {
    for (const std::string_view format : image_formats) {
        ResinPrinter printer = tiny_printer;
        printer.height_mm = 0;
        printer.bottom_layers = 3;
        const std::string sound = job_of(format, squares(60), {.printer = &printer});
        test::expect_same_layers(sound);
        std::mt19937_64 random(5);
        for (int round = 0; round < test::rounds_within_reason(40); ++round) {
            std::string bytes = sound;
            const std::size_t from =
                round % 2 == 0 ? 0 : bytes.size() - std::min<std::size_t>(bytes.size(), 9000);
            for (std::uint64_t n = random() % 3 + 1; n > 0; --n)
                bytes[from + random() % (bytes.size() - from)] = static_cast<char>(random());
            EXPECT_TRUE(same_outcome(layer_outcome(bytes, {}, 3), layer_outcome(bytes))) << format;
        }
    }
}

class LargeLayers : public testing::TestWithParam<LayerSample> {};

INSTANTIATE_TEST_SUITE_P(Files, LargeLayers, testing::ValuesIn(large_samples()), test_name);

TEST_P(LargeLayers, AreTheSameForAnyNumberOfThreadsAndInMemoryOrNot) {
    test::expect_same_layers(GetParam().bytes());
}

TEST_P(LargeLayers, HaveTheSameDefectForAnyNumberOfThreads) {
    std::mt19937_64 random(44);
    const std::string sound = GetParam().bytes();
    for (int round = 0; round < test::rounds_within_reason(24); ++round) {
        std::string bytes = sound;
        for (std::uint64_t n = random() % 4 + 1; n > 0; --n) {
            const std::size_t at = random() % bytes.size();
            if (random() % 5 == 0)
                bytes.resize(at + 1);
            else
                bytes[at] = "\xff\0x<>,{}\"$ /-9"[random() % 16];
        }
        const std::string one = layer_outcome(bytes);
        for (const unsigned threads : {2U, 7U})
            EXPECT_TRUE(same_outcome(layer_outcome(bytes, {}, threads), one))
                << threads << " threads, round " << round;
    }
}

TEST_P(LargeLayers, KeepTheSameLimitOfMemoryForAnyNumberOfThreads) {
    const std::string bytes = GetParam().bytes();
    const std::string whole = layer_outcome(bytes);
    for (std::uint64_t limit = bytes.size() / 2; limit < 16 * bytes.size(); limit = limit * 5 / 4) {
        const std::string one = layer_outcome(bytes, {.max_memory = limit});
        for (const unsigned threads : {2U, 7U})
            EXPECT_TRUE(same_outcome(layer_outcome(bytes, {.max_memory = limit}, threads), one))
                << threads << " threads, " << limit << " bytes";
        const std::string passed = layer_outcome(bytes, {.max_memory = limit, .kept = KeptPlanes::none});
        EXPECT_TRUE(passed.starts_with("error") || passed == whole) << limit << " bytes";
    }
}

TEST_P(LargeLayers, AreNotReadOnceTheyAreCancelled) {
    const std::string bytes = GetParam().bytes();
    CancelFlag cancel;
    cancel.request();
    for (const unsigned threads : {1U, 3U})
        static_cast<void>(test::error_of(ErrorKind::cancelled, [&] {
            static_cast<void>(read_layers(std::as_bytes(std::span(bytes)), "layers", {},
                                          {.threads = threads, .cancel = &cancel}));
        }));
}

} // namespace
} // namespace lamella::hostile_layers
