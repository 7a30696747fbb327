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
    case MeshFormat::three_mf:
        return "3mf";
    case MeshFormat::amf:
        return "amf";
    case MeshFormat::obj:
        return "obj";
    case MeshFormat::ply:
        return "ply";
    case MeshFormat::off:
        return "off";
    }
    return "unknown";
}

Mesh MeshFile::placed(std::size_t i) const {
    return objects[instances[i].object].mesh.transformed(instances[i].placement);
}

Mesh MeshFile::mesh(const Execution& execution) const {
    std::vector<Mesh> all;
    for (std::size_t i = 0; i < instances.size(); ++i)
        all.push_back(placed(i));
    return joined(all, execution);
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
