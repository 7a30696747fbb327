#pragma once

// Base of the writers of jobs for resin printers.

#include "lamella/slices/layer_writer.hpp"
#include "lamella/slices/resin_job.hpp"

#include "raster/relief.hpp"
#include "slices/engine/ordered_writer.hpp"
#include "slices/images/display.hpp"
#include "slices/images/layer_images.hpp"
#include "slices/images/resin_plan.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella {

/// Returns the printer of the options for a format. Without one, the options of images must determine the
/// pixels of the display, which is taken to be mirrored along x, as nearly all are; or the layers have
/// images, whose display it is. Throws Error{usage} if none of these is given, or if the printer reads
/// another format.
[[nodiscard]] ResinPrinter printer_for(const LayerFileInfo& info, const LayerWriteOptions& options,
                                       std::string_view format);

/// Returns the name of the printer as files of its maker have it. Without a printer, it is the one for which
/// the images of the layers were made.
[[nodiscard]] std::string machine_name_of(const LayerFileInfo& info, const ResinPrinter& printer);

/// Layers and abilities of a format.
struct ResinJobKind {
    std::string_view name; ///< in messages, such as "an SL1 job"
    /// True if layers may have heights of their own; otherwise only the first layer may.
    bool own_heights = true;
    /// False if the file has one exposure for all layers above the bottom.
    bool own_exposures = true;
    /// False if the plate moves in one stage.
    bool stages = true;
    /// False if the file does not say whether the display is mirrored along this axis. Readers then take it
    /// from the list of printers.
    bool mirror_x = true;
    bool mirror_y = true;
};

struct ResinLayer {
    std::uint64_t number = 0; ///< 0 for the first
    double top_mm = 0;        ///< above the plate
    double thickness_mm = 0;
    double exposure_s = 0;
    double area_mm2 = 0;
};

struct ResinTotals {
    std::uint64_t layers = 0;
    double first_layer_mm = 0;
    double layer_mm = 0; ///< of the second layer, if there is one
    double height_mm = 0;
    double volume_ml = 0;
    double mass_g = 0;
    double price = 0;
    double print_time_s = 0;
    std::uint64_t small_layers = 0; ///< see ResinPrinter::large_area
    std::uint64_t large_layers = 0;
};

/// Draws a preview, counts and checks layers, and knows the exposure of each.
class ResinWriter : public OrderedWriter {
  public:
    const ResinJob* resin_job() const noexcept final { return &job_; }

  protected:
    ResinWriter(const LayerFileInfo& info, const LayerWriteOptions& options, const ResinJobKind& kind,
                const ResinPrinter& printer)
        : ResinWriter(info, options, kind, printer, display_grid(info, options.image, printer)) {}

    /// Appends a layer to the file, or leaves that to completions. Called in order.
    using WriteLayer = std::function<void(const ResinLayer& layer, Completions& after)>;
    struct DrawnLayer {
        RasterAreas areas;
        WriteLayer write;
    };
    /// Draws and encodes the image of a layer. Called from any threads. `index` is that of the layer, which
    /// usually is ResinLayer::number.
    [[nodiscard]] virtual DrawnLayer drawn(const Plane& plane, std::uint64_t index) = 0;
    /// Returns the value that readers get for a pixel.
    [[nodiscard]] virtual std::uint8_t read_back(std::uint8_t value) const noexcept { return value; }
    /// Ends the file and gives it its name.
    virtual void end_job(const ResinTotals& totals) = 0;
    /// Counts a setting of a converted file that the format cannot hold.
    void leave_out(std::string setting);

    [[nodiscard]] const ResinPrinter& printer() const noexcept { return printer_; }
    [[nodiscard]] const Display& display() const noexcept { return display_; }
    [[nodiscard]] const PixelGrid& grid() const noexcept { return drawing_.grid(); }
    [[nodiscard]] const RasterOptions& raster() const noexcept { return drawing_.options(); }
    [[nodiscard]] const PlaneDrawing& drawing() const noexcept { return drawing_; }
    [[nodiscard]] const ResinPlan& plan() const noexcept { return plan_; }
    /// Returns the largest height of a part, or the height of this one if the printer's is unknown.
    [[nodiscard]] double machine_mm() const noexcept;
    [[nodiscard]] const std::string& machine_name() const noexcept { return machine_name_; }
    /// Returns the image of the part from all layers that were written.
    [[nodiscard]] ColourImage preview() const { return relief_.image(); }

  private:
    ResinWriter(const LayerFileInfo& info, const LayerWriteOptions& options, const ResinJobKind& kind,
                const ResinPrinter& printer, const DisplayGrid& display);
    Write formatted(const Plane& plane) final;
    void end_file() final;
    void check_mirroring();
    [[nodiscard]] Finding changed_pixels(const Plane& plane) const;
    void check_heights(const PlanePosition& offset);
    [[nodiscard]] ResinLayer counted(const PlanePosition& offset, double area_mm2);

    ResinJobKind kind_;
    ResinPrinter printer_;
    Display display_;
    std::string machine_name_;
    PlaneDrawing drawing_;
    ResinPlan plan_;
    Relief relief_;
    double bottom_; ///< of the first layer
    double part_mm_;
    double top_ = 0; ///< of the previous layer
    double volume_mm3_ = 0;
    ResinTotals totals_;
    ResinJob job_;
};

} // namespace lamella
