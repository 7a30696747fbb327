#pragma once

// Layers on their way from the ranks that sliced them to the one that writes.

#include "lamella/contour/layer.hpp"
#include "lamella/pipeline/ranks.hpp"
#include "lamella/write/layer_writer.hpp"

#include <memory>
#include <string>
#include <vector>

namespace lamella {

/// A writer that keeps layers as messages.
class LayerMessages final : public LayerWriter {
  public:
    [[nodiscard]] std::function<void()> prepare(std::span<const Layer> parts) override;
    void finish() override {}
    [[nodiscard]] std::uint64_t bytes() const noexcept override { return 0; }

    /// To rank 0, which calls write_messages.
    void send(Communicator& ranks);

  private:
    std::vector<std::string> messages_;
};

/// On rank 0: hands the layers of all other ranks to the writer, in order. Should the writer fail, the rest
/// of them is received nevertheless.
void write_messages(Communicator& ranks, LayerWriter& writer);

} // namespace lamella
