#include "image_options.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"

#include "numbers.hpp"
#include "options.hpp"
#include "resin_settings_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>

namespace lamella::app {
namespace {

/// Parses "F" or "X,Y".
AlongXY<double> parse_lengths(const std::string& text) {
    const std::vector<double> numbers = parse_numbers(text);
    if (numbers.size() > 2 || std::any_of(numbers.begin(), numbers.end(), [](double n) { return !(n > 0); }))
        throw Error(ErrorKind::usage,
                    fmt::format("\"{}\" is not a length or two, such as 0.05 or 120,68", excerpt(text)));
    return {numbers.front(), numbers.back()};
}

/// Parses "WxH".
AlongXY<std::uint32_t> parse_pixels(const std::string& text) {
    const auto refuse = [&] {
        throw Error(ErrorKind::usage,
                    fmt::format("\"{}\" is not a number of columns and of rows up to {}, such "
                                "as 2560x1440",
                                excerpt(text), most_pixels));
    };
    const auto cross = text.find('x');
    if (cross == std::string::npos)
        refuse();
    std::array<std::uint64_t, 2> sides{};
    try {
        sides = {parse_count(text.substr(0, cross)), parse_count(text.substr(cross + 1))};
    } catch (const Error&) {
        refuse();
    }
    if (std::any_of(sides.begin(), sides.end(), [](std::uint64_t n) { return n < 1 || n > most_pixels; }))
        refuse();
    return {static_cast<std::uint32_t>(sides[0]), static_cast<std::uint32_t>(sides[1])};
}

/// Parses "C:V,...".
GreyValues parse_grey_curve(const std::string& text) {
    std::vector<GreyPoint> points;
    for (const std::string_view point : list_items(text)) {
        const std::size_t colon = point.find(':');
        if (colon == std::string_view::npos)
            throw Error(ErrorKind::usage,
                        fmt::format("\"{}\" is not a covered part and a grey value, such as "
                                    "0.5:180",
                                    excerpt(point)));
        points.push_back({parse_number(point.substr(0, colon)), parse_number(point.substr(colon + 1))});
    }
    return grey_curve(points);
}

/// Parses "auto" or "#RRGGBB,...".
std::vector<PartColour> parse_colours(const std::string& text) {
    std::vector<PartColour> colours;
    if (text == "auto")
        return colours;
    for (const std::string_view one : list_items(text)) {
        std::uint32_t number = 0;
        const bool hash = one.size() == 7 && one.front() == '#';
        const char* const end = one.data() + one.size();
        if (!hash || std::from_chars(one.data() + 1, end, number, 16).ptr != end)
            throw Error(ErrorKind::usage,
                        fmt::format("\"{}\" is not a colour, such as #e6194b", excerpt(one)));
        colours.push_back({static_cast<std::uint8_t>(number >> 16),
                           static_cast<std::uint8_t>(number >> 8 & 255),
                           static_cast<std::uint8_t>(number & 255)});
    }
    return colours;
}

Option lengths(std::string name, std::string placeholder, std::string help,
               std::optional<AlongXY<double>>& target) {
    return row(std::move(name), ValueKind::numbers, std::move(placeholder), std::move(help),
               [&target](const std::string& text) { target = parse_lengths(text); });
}

Option positive(std::string name, std::string placeholder, std::string help, std::optional<double>& target) {
    return row(std::move(name), ValueKind::number, std::move(placeholder), std::move(help),
               [&target](const std::string& text) { target = parse_positive(text); });
}

Option count_within(std::string name, std::string help, std::uint32_t least, std::uint32_t most,
                    std::optional<std::uint32_t>& target) {
    return row(std::move(name), ValueKind::count, "N", std::move(help),
               [=, &target](const std::string& text) { target = parse_count_within(text, least, most); });
}

} // namespace

namespace {

/// Returns whether two names differ at most in the case of letters.
bool same_name(std::string_view a, std::string_view b) {
    const auto upper = [](char c) {
        return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    };
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [&](char left, char right) { return upper(left) == upper(right); });
}

/// Returns the printer of the job, if it is known and reads this format; otherwise null.
const ResinPrinter* printer_of(const ResinJob& job, const LayerFormat& format) {
    const std::span<const ResinPrinter> all = resin_printers();
    const auto found = std::find_if(all.begin(), all.end(), [&](const ResinPrinter& one) {
        return one.format == format.name && one.pixels.x == job.pixels.x && one.pixels.y == job.pixels.y &&
               same_name(one.name, job.printer);
    });
    return found == all.end() ? nullptr : &*found;
}

} // namespace

OptionGroup image_options(ImageArguments& target) {
    Option antialias =
        count_within("antialias",
                     "1: black or white, by the centre of each pixel; 2 to 64: grey, by the covered part of "
                     "each pixel, exact unless more than N corners are close together (default: 8)",
                     1, most_antialias, target.antialias);
    Option gamma =
        positive("gamma", "G", "the grey value is 255 x (covered part)^G (default: 1)", target.gamma);
    Option curve = row(
        "grey-curve", ValueKind::text, "C:V,...",
        "grey values V (0 to 255) of pixels whose covered part is C (0 to 1), interpolated between, instead "
        "of --gamma: 0:60,0.5:180 begins at 60 and ends at 255",
        [&target](const std::string& text) { target.grey_values = parse_grey_curve(text); });
    Option colours =
        row("part-colours", ValueKind::text, "auto|#RRGGBB,...",
            "png, png-zip: a colour for each part, in a palette, for printers of voxels: pixels have "
            "the colour of the part in which their middle lies, and are transparent elsewhere",
            [&target](const std::string& text) { target.part_colours = parse_colours(text); });
    Option fade = count_within(
        "fade-layers",
        "number of layers in which the first exposure time fades to the normal one (default: 5; sl1: 10)", 0,
        std::numeric_limits<std::uint32_t>::max(), target.fade_layers);
    return {
        "images",
        "Images and resin printers",
        {text("printer", "NAME",
              "resin printer, by its name or a part of it, such as \"Mars 4\": determines the display, and "
              "the "
              "format if --format does not",
              target.printer),
         lengths("pixel-size", "MM|X,Y", "size of a pixel (default for png and png-zip: 0.05)",
                 target.pixel_mm),
         row("resolution", ValueKind::text, "WxH",
             "pixels of the display along x and y (default for png and png-zip: as many as the part needs)",
             [&target](const std::string& text) { target.pixels = parse_pixels(text); }),
         lengths("display-size", "X,Y", "size of the display, instead of --pixel-size or --resolution",
                 target.display_mm),
         choice("orientation", "HOW", "direction of x in an image, to the right or upwards",
                {"landscape", "portrait"}, target.orientation),
         choice("mirror", "AXES", "axes along which the display is mirrored, as in PrusaSlicer",
                {"none", "x", "y", "xy"}, target.mirror),
         std::move(antialias), std::move(gamma), std::move(curve), std::move(colours),
         input_file("resin",
                    "TOML file of exposures, movements of the plate and the resin; see lamella resin",
                    target.resin),
         positive("exposure", "SECONDS",
                  "exposure time of a layer (default: that of the printer, such as 2.5; sl1: 7.5; sl1s: 2)",
                  target.exposure_s),
         positive("first-exposure", "SECONDS",
                  "exposure time of each of the first layers, whose number bottom_layers in --resin sets "
                  "(default: that of the printer, such as 30; sl1: 35; sl1s: 25)",
                  target.first_exposure_s),
         std::move(fade)}};
}

Option z_antialias_option(ImageArguments& target) {
    return count_within(
        "z-antialias",
        "each image shows the mean of N cuts, evenly spaced in the thickness of its layer: grey "
        "where a slope ends within the layer (default: 1, the cut of the layer)",
        1, most_antialias, target.cuts);
}

void ImageArguments::apply(const LayerFormat& format, LayerWriteOptions& options) const {
    const auto check = [&format](bool given, std::string_view option, bool LayerFormat::*takes) {
        check_format(format, given, option, takes);
    };
    check(!printer.empty(), "printer", &LayerFormat::image);
    check(pixel_mm.has_value(), "pixel-size", &LayerFormat::image);
    check(pixels.has_value(), "resolution", &LayerFormat::image);
    check(display_mm.has_value(), "display-size", &LayerFormat::image);
    check(!orientation.empty(), "orientation", &LayerFormat::image);
    check(!mirror.empty(), "mirror", &LayerFormat::image);
    check(antialias.has_value(), "antialias", &LayerFormat::image);
    check(gamma.has_value(), "gamma", &LayerFormat::image);
    check(grey_values.has_value(), "grey-curve", &LayerFormat::image);
    check(part_colours.has_value(), "part-colours", &LayerFormat::part_colours);
    if (part_colours && (antialias.value_or(1) > 1 || gamma || grey_values || cuts.value_or(1) > 1))
        throw Error(ErrorKind::usage, "--part-colours excludes --antialias, --gamma, --grey-curve and "
                                      "--z-antialias: pixels have the colour of a part or none");
    check(cuts.has_value(), "z-antialias", &LayerFormat::image);
    check(!resin.empty(), "resin", &LayerFormat::exposure);
    check(exposure_s.has_value(), "exposure", &LayerFormat::exposure);
    check(first_exposure_s.has_value(), "first-exposure", &LayerFormat::exposure);
    check(fade_layers.has_value(), "fade-layers", &LayerFormat::exposure);

    ImageOptions& image = options.image;
    image.pixel_mm = pixel_mm;
    image.pixels = pixels;
    image.display_mm = display_mm;
    if (!orientation.empty())
        image.portrait = orientation == "portrait";
    if (!mirror.empty()) {
        image.mirror_x = mirror.starts_with('x');
        image.mirror_y = mirror.ends_with('y');
    }
    image.raster.antialias = antialias.value_or(image.raster.antialias);
    image.raster.gamma = gamma.value_or(image.raster.gamma);
    image.raster.grey_values = grey_values;
    image.colour_parts = part_colours.has_value();
    image.part_colours = part_colours.value_or(image.part_colours);
    if (!printer.empty())
        options.printer = &find_resin_printer(printer);
    options.resin = settings_on({});
    if (format.exposure)
        options.resin.created_s = source_date();
}

ResinSettings ImageArguments::settings_on(ResinSettings settings) const {
    if (!resin.empty())
        settings = read_resin_settings(resin, std::move(settings));
    if (exposure_s)
        settings.exposure_s = exposure_s;
    if (first_exposure_s)
        settings.bottom_exposure_s = first_exposure_s;
    if (fade_layers)
        settings.transition_layers = fade_layers;
    return settings;
}

void ImageArguments::apply_to(const LayerFile& file, const LayerFormat& format, LayerFileInfo& info,
                              LayerWriteOptions& options) const {
    if (!file.resin || !format.image)
        return;
    const ResinJob& job = *file.resin;
    info.printer = job.printer;
    ResinSettings settings = settings_of(job, file.planes);
    if (!resin.empty() || exposure_s || first_exposure_s || fade_layers)
        settings.ranges.clear(); // they hold the exposures that the options replace
    settings.created_s = options.resin.created_s;
    options.resin = settings_on(std::move(settings));
    options.resin_of_file = true;
    if (!antialias && job.antialias > 1 && job.antialias <= most_antialias)
        options.image.raster.antialias = job.antialias;
    if (printer.empty() && info.grid)
        options.printer = printer_of(job, format);
}

std::optional<std::string> ImageArguments::other_printer(const LayerFile& file,
                                                         const LayerFormat& format) const {
    if (!file.resin || !format.exposure || !printer.empty())
        return std::nullopt;
    const std::span<const ResinPrinter> all = resin_printers();
    const auto found = std::find_if(all.begin(), all.end(), [&](const ResinPrinter& one) {
        return same_name(one.name, file.resin->printer) && one.format != format.name;
    });
    if (found == all.end() || printer_of(*file.resin, format) != nullptr)
        return std::nullopt;
    return fmt::format("the job is for the {}, which reads files of the format {} ({}), not {}; name another "
                       "printer with --printer",
                       found->name, found->format, found->extension, format.name);
}

} // namespace lamella::app
