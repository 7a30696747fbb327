#include "input_kind.hpp"

#include "lamella/core/error.hpp"
#include "lamella/read/file_kind.hpp"

#include "text_file.hpp"

#include <array>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <span>
#include <string_view>

namespace lamella::app {
namespace {

std::string head_of(const std::string& path) {
    struct Close {
        void operator()(std::FILE* file) const { static_cast<void>(std::fclose(file)); }
    };
    std::string head(4096, '\0');
    // What cannot be opened is reported by the reader.
    const std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "rb"));
    head.resize(file == nullptr ? 0 : std::fread(head.data(), 1, head.size(), file.get()));
    return head;
}

/// What `layers` reads, or what `mesh` reads when there are no layers.
template <class ReadLayers, class ReadMesh>
std::variant<MeshFile, LayerFile> layers_or_mesh(const ReadLayers& layers, const ReadMesh& mesh) {
    try {
        return layers();
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::input)
            throw;
    }
    return mesh();
}

} // namespace

std::variant<MeshFile, LayerFile> read_either(const std::string& path, const MeshReadOptions& options,
                                              const Execution& execution) {
    const auto choose = [](std::string_view head, const auto& layers,
                           const auto& mesh) -> std::variant<MeshFile, LayerFile> {
        switch (file_kind(head)) {
        case FileKind::layers:
            return layers();
        case FileKind::either:
            return layers_or_mesh(layers, mesh);
        case FileKind::mesh:
            break;
        }
        return mesh();
    };
    const LayerReadOptions reading{.max_memory = options.max_memory};
    if (path == "-") {
        // Standard input can be read only once.
        const std::string content = read_text_file(path, options.max_memory);
        const std::span<const std::byte> bytes = std::as_bytes(std::span(content));
        return choose(
            content, [&] { return read_layers(bytes, path, reading, execution); },
            [&] { return read_mesh(bytes, path, options, execution); });
    }
    return choose(
        head_of(path), [&] { return read_layers(path, reading, execution); },
        [&] { return read_mesh(path, options, execution); });
}

} // namespace lamella::app
