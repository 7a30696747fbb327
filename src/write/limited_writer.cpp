#include "lamella/core/error.hpp"

#include "write/layer_writers.hpp"

#include <fmt/format.h>

#include <utility>

namespace lamella {

namespace {

class LimitedWriter final : public LayerWriter {
  public:
    LimitedWriter(std::unique_ptr<LayerWriter> writer, std::string path, std::uint64_t most_bytes)
        : writer_(std::move(writer)), path_(std::move(path)), most_bytes_(most_bytes) {}

    std::function<void()> prepare(std::span<const Layer> parts) override {
        return [this, write = writer_->prepare(parts)] {
            write();
            check();
        };
    }

    void finish() override {
        check();
        writer_->finish();
    }

    std::uint64_t bytes() const noexcept override { return writer_->bytes(); }
    std::vector<std::string> warnings() const override { return writer_->warnings(); }

  private:
    void check() const {
        if (writer_->bytes() > most_bytes_)
            throw Error(
                ErrorKind::limit,
                fmt::format("'{}' would take more than the {} bytes that it may; choose higher layers, "
                            "another format or a larger limit",
                            path_, most_bytes_));
    }

    std::unique_ptr<LayerWriter> writer_;
    std::string path_;
    std::uint64_t most_bytes_;
};

} // namespace

std::unique_ptr<LayerWriter> limited(std::unique_ptr<LayerWriter> writer, std::string path,
                                     std::uint64_t most_bytes) {
    return std::make_unique<LimitedWriter>(std::move(writer), std::move(path), most_bytes);
}

} // namespace lamella
