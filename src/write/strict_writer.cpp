#include "lamella/core/error.hpp"

#include "write/layer_writers.hpp"

#include <fmt/format.h>

#include <utility>

namespace lamella {

namespace {

class StrictWriter final : public LayerWriter {
  public:
    StrictWriter(std::unique_ptr<LayerWriter> writer, std::string path)
        : writer_(std::move(writer)), path_(std::move(path)) {}

    std::function<void()> prepare(std::span<const Layer> parts) override { return writer_->prepare(parts); }

    void finish() override {
        if (const std::vector<std::string> losses = writer_->warnings(); !losses.empty())
            throw Error(ErrorKind::defect, fmt::format("{}: {}", path_, losses.front()));
        writer_->finish();
    }

    std::uint64_t bytes() const noexcept override { return writer_->bytes(); }
    std::vector<std::string> warnings() const override { return writer_->warnings(); }

  private:
    std::unique_ptr<LayerWriter> writer_;
    std::string path_;
};

} // namespace

std::unique_ptr<LayerWriter> strict(std::unique_ptr<LayerWriter> writer, std::string path) {
    return std::make_unique<StrictWriter>(std::move(writer), std::move(path));
}

} // namespace lamella
