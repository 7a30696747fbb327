#include "pipeline/layer_messages.hpp"

#include "pipeline/packed.hpp"

#include <exception>
#include <utility>

namespace lamella {
namespace {

std::string packed(std::span<const Layer> parts) {
    Packer packer;
    packer.put(std::uint64_t{parts.size()});
    for (const Layer& layer : parts)
        packer.put(layer.index)
            .put(layer.z)
            .put(layer.bottom)
            .put(layer.top)
            .put(std::uint64_t{layer.rings})
            .put_all(std::span(layer.offsets))
            .put_all(layer.points.span());
    return packer.take();
}

std::vector<Layer> unpacked(const std::string& message) {
    Unpacker unpacker(message);
    std::vector<Layer> parts(unpacker.get<std::uint64_t>());
    for (Layer& layer : parts) {
        layer.index = unpacker.get<std::uint64_t>();
        layer.z = unpacker.get<double>();
        layer.bottom = unpacker.get<double>();
        layer.top = unpacker.get<double>();
        layer.rings = unpacker.get<std::uint64_t>();
        layer.offsets = unpacker.get_all<std::uint64_t>();
        layer.points = PointArray(unpacker.get_all<Point2>());
    }
    return parts;
}

} // namespace

std::function<void()> LayerMessages::prepare(std::span<const Layer> parts) {
    return [this, message = packed(parts)]() mutable {
        messages_.push_back(std::move(message));
    };
}

void LayerMessages::send(Communicator& ranks) {
    for (std::string& message : messages_)
        ranks.send(0, std::exchange(message, {}));
    ranks.send(0, {});
}

void write_messages(Communicator& ranks, LayerWriter& writer) {
    std::exception_ptr error;
    for (std::size_t from = 1; from < ranks.size(); ++from)
        for (std::string message; !(message = ranks.receive(from)).empty();) {
            if (error)
                continue;
            try {
                writer.prepare(unpacked(message))();
            } catch (...) {
                error = std::current_exception();
            }
        }
    if (error)
        std::rethrow_exception(error);
}

} // namespace lamella
