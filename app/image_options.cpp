#include "image_options.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"

#include "numbers.hpp"
#include "options.hpp"
#include "resin_settings_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
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

OptionGroup image_options(ImageArguments& target) {
    Option antialias =
        count_within("antialias",
                     "1: black or white, by the centre of each pixel; 2 to 64: grey, by the covered part of "
                     "each pixel, exact unless more than N corners are close together (default: 8)",
                     1, most_antialias, target.antialias);
    Option gamma =
        positive("gamma", "G", "the grey value is 255 x (covered part)^G (default: 1)", target.gamma);
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
         std::move(antialias), std::move(gamma),
         input_file("resin",
                    "TOML file of exposures, movements of the plate and the resin; see lamella resin",
                    target.resin),
         positive("exposure", "SECONDS",
                  "exposure time of a layer (default: that of the printer, such as 2.5; sl1: 7.5; sl1s: 2)",
                  target.exposure_s),
         positive("first-exposure", "SECONDS",
                  "exposure time of the first layers (default: that of the printer, such as 30; sl1: 35; "
                  "sl1s: 25)",
                  target.first_exposure_s),
         std::move(fade)}};
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
    if (!printer.empty())
        options.printer = &find_resin_printer(printer);
    if (!resin.empty())
        options.resin = read_resin_settings(resin);
    if (exposure_s)
        options.resin.exposure_s = exposure_s;
    if (first_exposure_s)
        options.resin.bottom_exposure_s = first_exposure_s;
    if (fade_layers)
        options.resin.transition_layers = fade_layers;
    if (format.exposure)
        options.resin.created_s = source_date();
}

} // namespace lamella::app
