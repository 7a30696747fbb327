#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"
#include "lamella/core/suggest.hpp"
#include "lamella/slices/resin_printer.hpp"

#include "core/lower_case.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace lamella {

namespace {

/// The files of a printer.
struct FilesOfPrinter {
    std::string_view format;
    std::string_view extension;
    std::uint32_t version = 0;
};

constexpr FilesOfPrinter goo_files{"goo", ".goo"};
constexpr FilesOfPrinter prz_files{"goo", ".prz"};
constexpr FilesOfPrinter ctb3_files{"ctb", ".ctb", 3};
constexpr FilesOfPrinter ctb4_files{"ctb", ".ctb", 4};
constexpr FilesOfPrinter photon_files{"cbddlp", ".photon", 2};
constexpr FilesOfPrinter zip_files{"chitubox-zip", ".zip"};
constexpr FilesOfPrinter nanodlp_files{"nanodlp", ".nanodlp"};

constexpr FilesOfPrinter anycubic_files(std::string_view extension, std::uint32_t version) {
    return {"anycubic", extension, version};
}

enum class Mirroring { not_mirrored, mirrored_x, mirrored_y };
using enum Mirroring;

enum class Shades { grey, black_and_white };
constexpr Shades black_and_white = Shades::black_and_white;

/// A printer that lifts the plate. Displays of 1440 columns are made for colours; they let less light pass
/// than those without colours, so their exposures are longer.
constexpr ResinPrinter lifting(std::string_view name, FilesOfPrinter files, AlongXY<std::uint32_t> pixels,
                               AlongXY<double> display_mm, double height_mm, Mirroring mirroring,
                               Shades shades = Shades::grey) {
    const bool coloured = pixels.x == 1440;
    return {.name = name,
            .format = files.format,
            .extension = files.extension,
            .version = files.version,
            .pixels = pixels,
            .display_mm = display_mm,
            .mirror_x = mirroring == mirrored_x,
            .mirror_y = mirroring == mirrored_y,
            .height_mm = height_mm,
            .grey = shades == Shades::grey,
            .exposure_s = coloured ? 8 : 2.5,
            .bottom_exposure_s = coloured ? 60.0 : 30.0};
}

// The exposures are Prusa's values for its Orange Tough resin in layers of 0.05 mm.
constexpr ResinPrinter original_sl1{.name = "Original Prusa SL1",
                                    .format = "sl1",
                                    .extension = ".sl1",
                                    .pixels = {2560, 1440},
                                    .display_mm = {120.96, 68.04},
                                    .portrait = true,
                                    .mirror_x = true,
                                    .height_mm = 150,
                                    .exposure_s = 7.5,
                                    .bottom_exposure_s = 35,
                                    .bottom_layers = 3,
                                    .transition_layers = 10,
                                    .large_area = 0.5,
                                    .small_pause_s = 5,
                                    .large_pause_s = 8};
constexpr ResinPrinter original_sl1s{.name = "Original Prusa SL1S",
                                     .format = "sl1s",
                                     .extension = ".sl1s",
                                     .pixels = {2560, 1620},
                                     .display_mm = {128, 81},
                                     .portrait = true,
                                     .mirror_x = true,
                                     .height_mm = 150,
                                     .exposure_s = 2,
                                     .bottom_exposure_s = 25,
                                     .bottom_layers = 3,
                                     .transition_layers = 10,
                                     .large_area = 0.45,
                                     .small_pause_s = 2.5,
                                     .large_pause_s = 5};

// Printers that read only encrypted files are missing, and those whose formats are not written.
constexpr std::array printers{
    lifting("Anycubic Photon", photon_files, {1440, 2560}, {68.04, 120.96}, 155, mirrored_x),
    lifting("Anycubic Photon M3", anycubic_files(".pm3", 516), {4096, 2560}, {163.84, 102.4}, 180,
            mirrored_x),
    lifting("Anycubic Photon M3 Max", anycubic_files(".pm3m", 516), {6480, 3600}, {298.08, 165.6}, 300,
            mirrored_x),
    // For this one, Photon Workshop writes the older version.
    lifting("Anycubic Photon Mono", anycubic_files(".pwmo", 515), {1620, 2560}, {82.62, 130.56}, 165,
            mirrored_x),
    lifting("Anycubic Photon Mono 4K", anycubic_files(".pwma", 516), {3840, 2400}, {134.4, 84}, 165,
            mirrored_x),
    lifting("Anycubic Photon Mono SE", anycubic_files(".pwms", 516), {1620, 2560}, {82.62, 130.56}, 160,
            mirrored_x, black_and_white),
    lifting("Anycubic Photon Mono SQ", anycubic_files(".pmsq", 516), {2400, 2560}, {120, 128}, 200,
            mirrored_x),
    lifting("Anycubic Photon Mono X", anycubic_files(".pwmx", 516), {3840, 2400}, {192, 120}, 245, mirrored_x,
            black_and_white),
    lifting("Anycubic Photon Mono X 6K", anycubic_files(".pwmb", 516), {5760, 3600}, {198.15, 123.84}, 245,
            mirrored_x, black_and_white),
    lifting("Anycubic Photon Ultra", anycubic_files(".dlp", 516), {1280, 720}, {102.4, 57.6}, 165,
            mirrored_x),
    lifting("Concepts3D Athena 12K", nanodlp_files, {11520, 5120}, {218.88, 122.88}, 245, mirrored_x),
    lifting("Concepts3D Athena 8K", nanodlp_files, {7680, 4320}, {218.88, 123.12}, 245, mirrored_x),
    lifting("Creality LD-002H", ctb3_files, {1620, 2560}, {82.62, 130.56}, 160, mirrored_x),
    lifting("Creality LD-002R", ctb3_files, {1440, 2560}, {68.04, 120.96}, 160, mirrored_x),
    lifting("Creality LD-006", ctb3_files, {3840, 2400}, {192, 120}, 245, mirrored_x),
    lifting("Elegoo Mars", ctb3_files, {1440, 2560}, {68.04, 120.96}, 150, mirrored_x),
    lifting("Elegoo Mars 2", ctb4_files, {1620, 2560}, {82.62, 130.56}, 150, mirrored_x),
    lifting("Elegoo Mars 2 Pro", ctb4_files, {1620, 2560}, {82.62, 130.56}, 160, mirrored_x),
    lifting("Elegoo Mars 4", goo_files, {8520, 4320}, {153.36, 77.76}, 175, mirrored_x),
    lifting("Elegoo Mars 4 DLP", goo_files, {2560, 1440}, {132.8, 74.7}, 150, mirrored_x),
    lifting("Elegoo Mars 4 Max", goo_files, {5760, 3600}, {195.84, 122.4}, 150, mirrored_x),
    lifting("Elegoo Mars 4 Ultra", goo_files, {8520, 4320}, {153.36, 77.76}, 165, mirrored_x),
    lifting("Elegoo Mars 5", goo_files, {4098, 2560}, {143.43, 89.6}, 150, mirrored_x),
    lifting("Elegoo Mars C", ctb3_files, {1440, 2560}, {68.04, 120.96}, 150, mirrored_x),
    lifting("Elegoo Saturn", ctb3_files, {3840, 2400}, {192, 120}, 200, mirrored_x),
    lifting("Elegoo Saturn 3", goo_files, {11520, 5120}, {218.88, 122.88}, 250, mirrored_x),
    lifting("Elegoo Saturn 3 Ultra", goo_files, {11520, 5120}, {218.88, 122.88}, 260, mirrored_x),
    lifting("Elegoo Saturn 4", goo_files, {11520, 5120}, {218.88, 122.88}, 220, mirrored_x),
    lifting("EPAX E10 Mono", ctb3_files, {3840, 2400}, {192, 120}, 250, mirrored_x),
    lifting("EPAX E6 Mono", ctb3_files, {1620, 2560}, {81, 128}, 155, mirrored_x),
    lifting("EPAX X1", ctb3_files, {1440, 2560}, {68.04, 120.96}, 155, mirrored_x),
    lifting("EPAX X10", ctb3_files, {1600, 2560}, {135.36, 216.57}, 250, mirrored_x),
    lifting("EPAX X10 4K Mono", ctb3_files, {3840, 2400}, {192, 120}, 250, mirrored_x),
    lifting("EPAX X133 4K Mono", ctb3_files, {3840, 2160}, {293.76, 165.24}, 400, mirrored_x),
    lifting("EPAX X156 4K Color", ctb3_files, {3840, 2160}, {345.6, 194.4}, 400, mirrored_x),
    lifting("EPAX X1K 2K Mono", ctb3_files, {1620, 2560}, {82.62, 130.56}, 155, mirrored_x),
    lifting("Kelant S400", zip_files, {2560, 1600}, {192, 120}, 200, mirrored_x),
    original_sl1,
    original_sl1s,
    lifting("Peopoly Phenom", ctb3_files, {3840, 2160}, {276.48, 155.52}, 400, mirrored_x),
    lifting("Peopoly Phenom L", ctb3_files, {3840, 2160}, {345.6, 194.4}, 400, mirrored_x),
    lifting("Peopoly Phenom Noir", ctb3_files, {3840, 2160}, {293.76, 165.24}, 400, mirrored_x),
    lifting("Peopoly Phenom XXL", ctb3_files, {3840, 2160}, {526.08, 295.92}, 550, mirrored_x),
    lifting("Phrozen Shuffle", zip_files, {1440, 2560}, {67.68, 120.32}, 200, not_mirrored),
    lifting("Phrozen Shuffle 16", ctb3_files, {3840, 2160}, {337.92, 190.08}, 400, mirrored_x),
    lifting("Phrozen Shuffle 4K", zip_files, {2160, 3840}, {68.04, 120.96}, 170, not_mirrored),
    lifting("Phrozen Shuffle Lite", zip_files, {1440, 2560}, {68.04, 120.96}, 170, not_mirrored),
    lifting("Phrozen Shuffle XL", zip_files, {2560, 1600}, {192, 120}, 200, not_mirrored),
    lifting("Phrozen Shuffle XL Lite", zip_files, {2560, 1600}, {192, 120}, 200, mirrored_x),
    lifting("Phrozen Sonic", zip_files, {1080, 1920}, {68.04, 120.96}, 170, mirrored_x),
    lifting("Phrozen Sonic 4K", ctb3_files, {3840, 2160}, {134.4, 75.6}, 200, mirrored_x),
    lifting("Phrozen Sonic Mighty 4K", ctb3_files, {3840, 2400}, {199.68, 124.8}, 220, mirrored_x),
    lifting("Phrozen Sonic Mini 4K", ctb3_files, {3840, 2160}, {134.4, 75.6}, 130, mirrored_x),
    lifting("Phrozen Sonic Mini 8K S", prz_files, {7536, 3240}, {165.792, 71.28}, 170, mirrored_x),
    lifting("Phrozen Transform", zip_files, {3840, 2160}, {291.84, 164.16}, 400, not_mirrored),
    lifting("QIDI I-Box Mono", ctb3_files, {3840, 2400}, {192, 120}, 200, mirrored_x),
    lifting("QIDI S-Box", ctb3_files, {1600, 2560}, {135.36, 216.576}, 200, mirrored_x),
    lifting("QIDI Shadow5.5", ctb3_files, {1440, 2560}, {68.04, 120.96}, 150, mirrored_x),
    lifting("QIDI Shadow6.0 Pro", ctb3_files, {1440, 2560}, {74.52, 132.48}, 150, mirrored_x),
    lifting("Uniz IBEE (Klipper)", zip_files, {3840, 2400}, {192, 120}, 220, mirrored_y),
    lifting("Wanhao CGR Mini Mono", zip_files, {1620, 2560}, {82.62, 130.56}, 200, mirrored_x),
    lifting("Wanhao CGR Mono", zip_files, {1620, 2560}, {192, 120}, 200, mirrored_x),
    lifting("Wanhao D8", zip_files, {2560, 1600}, {192, 120}, 180, mirrored_x),
};

/// Returns the names of printers, or some of them if they are many.
std::string some_names(const std::vector<const ResinPrinter*>& some) {
    constexpr std::size_t most = 12;
    std::vector<std::string_view> names;
    for (std::size_t i = 0; i < std::min(some.size(), most); ++i)
        names.push_back(some[i]->name);
    const std::string more =
        some.size() > most ? fmt::format(" and {} more", some.size() - most) : std::string();
    return fmt::format("{}{}", fmt::join(names, ", "), more);
}

/// Returns the printers whose lower-case name fits the text.
template <class Fits>
std::vector<const ResinPrinter*> fitting(const Fits& fits) {
    std::vector<const ResinPrinter*> found;
    for (const ResinPrinter& printer : printers)
        if (fits(lower_case(printer.name)))
            found.push_back(&printer);
    return found;
}

/// Returns the name that is most similar to the text, with or without its maker.
std::string similar_name(const std::string& text) {
    std::vector<std::string> candidates;
    for (const ResinPrinter& printer : printers) {
        const std::string name = lower_case(printer.name);
        candidates.push_back(name);
        candidates.push_back(name.substr(name.find(' ') + 1));
    }
    const std::string meant = nearest(text, candidates);
    const auto at = std::find(candidates.begin(), candidates.end(), meant);
    return at == candidates.end()
               ? ""
               : std::string(printers[static_cast<std::size_t>(at - candidates.begin()) / 2].name);
}

} // namespace

std::span<const ResinPrinter> resin_printers() noexcept {
    return printers;
}

const ResinPrinter& find_resin_printer(std::string_view text) {
    const std::string wanted = lower_case(text);
    if (!wanted.empty()) {
        const auto exact = fitting([&](const std::string& name) { return name == wanted; });
        if (!exact.empty())
            return *exact.front();
        const auto without_maker =
            fitting([&](const std::string& name) { return name.ends_with(' ' + wanted); });
        if (without_maker.size() == 1)
            return *without_maker.front();
        const auto part =
            fitting([&](const std::string& name) { return name.find(wanted) != std::string::npos; });
        if (part.size() == 1)
            return *part.front();
        if (!part.empty())
            throw Error(ErrorKind::usage, fmt::format("'{}' is part of the names of several printers: {}",
                                                      excerpt(text), some_names(part)));
    }
    const std::string meant = similar_name(wanted);
    throw Error(ErrorKind::usage,
                fmt::format("there is no printer '{}'{}", excerpt(text),
                            meant.empty()
                                ? "; give a part of its name, such as Mars 4 or Mono X, or the pixels "
                                  "and the size of its display"
                                : fmt::format("; did you mean {}?", meant)));
}

} // namespace lamella
