#include "jobs/job_output.hpp"

#include <utility>

namespace lamella {

Rounding OutputFiles::rounding() const noexcept {
    Rounding rounding = format == nullptr ? Rounding{} : format->rounding.value_or(Rounding{});
    if ((rounding.step_mm > 0 && format->units) ||
        (format != nullptr && format->short_form && write.short_form))
        rounding = {.step_mm = write.units_mm};
    return rounding;
}

JobOutput::JobOutput(const OutputFiles& files, const LayerFileInfo& info, std::unique_ptr<LayerWriter> writer)
    : format_(files.format), writer_(std::move(writer)) {
    if (format_ != nullptr && !writer_)
        writer_ = open_layer_writer(files.path, *format_, info, files.write);
    if (!files.page_path.empty())
        page_ = open_layer_page(files.page_path, info, files.page);
}

Commit JobOutput::prepare(const Plane& plane) {
    Commit to_file;
    if (writer_)
        to_file = writer_->prepare(plane);
    if (!page_)
        return to_file;
    return [to_file = std::move(to_file), to_page = page_->prepare(plane)](Completions& after) {
        if (to_file)
            to_file.in_order(after);
        to_page.in_order(after);
    };
}

void JobOutput::finish_file(FileResult& result) {
    if (!writer_)
        return;
    writer_->finish();
    result.format = format_->name;
    result.bytes = writer_->bytes();
    result.losses = writer_->findings();
    if (const ResinJob* const job = writer_->resin_job())
        result.resin = *job;
}

Findings JobOutput::finish_page(const PageNotes& notes) {
    page_->add_notes(notes);
    page_->finish();
    return page_->findings();
}

} // namespace lamella
