#include "lamella/read/mesh_file.hpp"

#include "container/byte_source.hpp"
#include "read/stl.hpp"

namespace lamella {

const char* format_name(MeshFormat format) noexcept {
    switch (format) {
    case MeshFormat::stl_binary:
        return "stl-binary";
    case MeshFormat::stl_ascii:
        return "stl-ascii";
    }
    return "unknown";
}

MeshFile read_mesh(const std::string& path, const MeshReadOptions& options, const Execution& execution) {
    MeshFile file = read_stl(open_bytes(path, execution.cancel), options, execution);
    file.path = path;
    return file;
}

MeshFile read_mesh(std::span<const std::byte> bytes, const std::string& name, const MeshReadOptions& options,
                   const Execution& execution) {
    MeshFile file = read_stl(copy_bytes(bytes, name), options, execution);
    file.path = name;
    return file;
}

} // namespace lamella
