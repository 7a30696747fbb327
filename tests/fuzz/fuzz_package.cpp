// Any texts as the parts of a 3MF package, behind the checksums and the compression of the archive: an error,
// or instances of sound meshes that lie at finite places. Parts are separated by a NUL: the root model,
// another one ("3D/a.model"), and the relationships of the root ("3D/_rels/3dmodel.model.rels").

#include <lamella/lamella.hpp>

#include <array>
#include <cmath>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>

namespace {

void require(bool promise) {
    if (!promise)
        std::abort();
}

std::uint32_t crc32(std::string_view bytes) {
    std::uint32_t crc = 0xFFFFFFFF;
    for (const char byte : bytes) {
        crc ^= static_cast<unsigned char>(byte);
        for (int bit = 0; bit < 8; ++bit)
            crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xEDB88320U : 0U);
    }
    return ~crc;
}

/// A zip archive of stored entries.
class Archive {
  public:
    void add(std::string_view name, std::string_view content) {
        const std::size_t place = file_.size();
        const auto head = [&](std::string& out) {
            put(out, {20, 0, 0, 0, 33}, 2);
            put(out, {crc32(content), content.size(), content.size()}, 4);
            put(out, {name.size(), 0}, 2);
        };
        put(file_, {0x04034b50}, 4);
        head(file_);
        file_.append(name).append(content);
        put(directory_, {0x02014b50}, 4);
        put(directory_, {20}, 2);
        head(directory_);
        put(directory_, {0, 0, 0}, 2);
        put(directory_, {0, place}, 4);
        directory_.append(name);
        ++entries_;
    }

    std::string take() {
        const std::size_t place = file_.size();
        file_ += directory_;
        put(file_, {0x06054b50}, 4);
        put(file_, {0, 0, entries_, entries_}, 2);
        put(file_, {directory_.size(), place}, 4);
        put(file_, {0}, 2);
        return std::move(file_);
    }

  private:
    static void put(std::string& out, std::initializer_list<std::uint64_t> values, int bytes) {
        for (const std::uint64_t value : values)
            for (int i = 0; i < bytes; ++i)
                out += static_cast<char>(value >> (8 * i));
    }

    std::string file_;
    std::string directory_;
    std::uint64_t entries_ = 0;
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lamella;
    std::string_view text(reinterpret_cast<const char*>(data), size);
    Archive archive;
    for (const char* name : {"3D/3dmodel.model", "3D/a.model", "3D/_rels/3dmodel.model.rels"}) {
        const std::size_t end = std::min(text.find('\0'), text.size());
        archive.add(name, text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    const std::string bytes = archive.take();
    try {
        const MeshFile file = read_mesh(std::as_bytes(std::span(bytes)), "fuzz",
                                        {.max_triangles = 50'000, .max_memory = 100'000'000}, {.threads = 1});
        require(!file.objects.empty() && !file.instances.empty());
        if (file.format == MeshFormat::stl_binary)
            return 0; // the archive happens to have the count of one
        for (const MeshObject& object : file.objects) {
            require(!object.mesh.empty());
            check(*object.mesh.indexed());
        }
        for (const MeshInstance& instance : file.instances) {
            require(finite(instance.placement));
            const Box3 box = bounding_box(file.objects[instance.object].mesh);
            for (const Point3& corner : {instance.placement(box.min), instance.placement(box.max)})
                require(std::isfinite(corner.x) && std::isfinite(corner.y) && std::isfinite(corner.z));
        }
    } catch (const Error& error) {
        require(error.kind() == ErrorKind::input || error.kind() == ErrorKind::limit);
    }
    return 0;
}
