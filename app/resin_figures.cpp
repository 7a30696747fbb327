#include "resin_figures.hpp"

#include "lamella/slices/resin_job.hpp"

#include "messages.hpp"
#include "numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

namespace lamella::app {
namespace {

/// Returns "0.05 mm", or the least and the greatest of several heights.
std::string heights_text(double least, double greatest) {
    const std::string first = fmt::format("{:.4g}", least);
    const std::string last = fmt::format("{:.4g}", greatest);
    return first == last ? first + " mm" : fmt::format("{} to {} mm", first, last);
}

Figure heights_figure(const LayerFile& file) {
    double least = file.planes.front().thickness();
    double greatest = least;
    for (const Layer& plane : file.planes) {
        least = std::min(least, plane.thickness());
        greatest = std::max(greatest, plane.thickness());
    }
    return {"layer_heights", {least, greatest}, "layer height", heights_text(least, greatest)};
}

Figure exposures_figure(const ResinJob& job) {
    const auto [least, greatest] = std::minmax_element(job.exposures_s.begin(), job.exposures_s.end());
    std::string text = fmt::format("{:.4g} s", *least);
    if (*least != *greatest)
        text = fmt::format("{:.4g} to {:.4g} s", *least, *greatest);
    if (const ResinSettings& settings = job.settings; settings.bottom_layers && settings.bottom_exposure_s)
        text += fmt::format(", {} of {:.4g} s", counted(*settings.bottom_layers, "bottom layer"),
                            *settings.bottom_exposure_s);
    return {"exposures_s", job.exposures_s, "exposure", std::move(text)};
}

void add_known(Figures& figures, std::string_view key, double value, std::string_view name,
               std::string text) {
    if (value > 0)
        figures.push_back({key, value, name, std::move(text)});
}

} // namespace

Figures amount_figures(const ResinJob& job) {
    Figures figures;
    add_known(figures, "resin_ml", job.volume_ml, "resin", fmt::format("{:.4g} ml", job.volume_ml));
    add_known(figures, "resin_g", job.mass_g, "mass", fmt::format("{:.4g} g", job.mass_g));
    const std::string currency = one_line(job.settings.currency.substr(0, job.settings.currency.find('/')));
    add_known(figures, "price", job.price, "price",
              fmt::format("{:.4g}{}{}", job.price, currency.empty() ? "" : " ", currency));
    const double seconds = std::round(job.time_s); // as most files have it
    add_known(figures, "print_seconds", seconds, "print time", duration(seconds));
    return figures;
}

Figures resin_figures(const LayerFile& file) {
    if (!file.resin)
        return {};
    const ResinJob& job = *file.resin;
    Figures figures;
    if (!job.version.empty())
        figures.push_back(
            {"format_version", job.version, "version", one_line(job.version) + " (of the format)"});
    if (!job.printer.empty())
        figures.push_back({"printer", job.printer, "printer", one_line(job.printer)});
    figures.push_back({"pixels",
                       {job.pixels.x, job.pixels.y},
                       "pixels",
                       fmt::format("{} x {}", job.pixels.x, job.pixels.y)});
    if (job.display_mm.x > 0)
        figures.push_back({"display_mm",
                           {job.display_mm.x, job.display_mm.y},
                           "display",
                           fmt::format("{:.6g} x {:.6g} mm", job.display_mm.x, job.display_mm.y)});
    figures.push_back(heights_figure(file));
    if (!job.exposures_s.empty())
        figures.push_back(exposures_figure(job));
    const Figures amounts = amount_figures(job);
    figures.insert(figures.end(), amounts.begin(), amounts.end());
    return figures;
}

} // namespace lamella::app
