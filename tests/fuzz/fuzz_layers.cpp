// Any bytes as a slice file: an error of the input kind, or layers in normal form that can be checked and
// written.

#include <lamella/lamella.hpp>

#include <cmath>
#include <cstdlib>
#include <span>

namespace {

void require(bool promise) {
    if (!promise)
        std::abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lamella;
    try {
        const LayerFile file = read_layers(std::as_bytes(std::span(data, size)), "fuzz", {.threads = 1});
        require(!file.parts.empty());
        const LayerStack layers = file.merged();
        require(!layers.empty());
        for (std::size_t i = 0; i < layers.size(); ++i) {
            const Layer& layer = layers[i];
            require(in_normal_form(layer));
            require(layer.bottom <= layer.top);
            require(i == 0 || layers[i - 1].z <= layer.z);
            for (const Point2& p : layer.points)
                require(std::isfinite(p.x) && std::isfinite(p.y));
        }
        static_cast<void>(verify(layers, {}, {.threads = 1}));
    } catch (const Error& error) {
        require(error.kind() == ErrorKind::input);
    }
    return 0;
}
