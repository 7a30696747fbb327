// The consortium's own library as an independent reader: the same triangles, volumes and boxes.

#include <Model/COM/NMR_DLLInterfaces.h>
#include <gtest/gtest.h>
#include <lamella/formats.hpp>

#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lamella {
namespace {

/// What is compared of a plate.
struct Sum {
    std::uint64_t triangles = 0;
    std::size_t meshes = 0;
    double volume = 0;
    Box3 box;

    void add(const Mesh& mesh) {
        triangles += mesh.size();
        ++meshes;
        volume += lamella::volume(mesh);
        box.add(bounding_box(mesh));
    }
};

Transform transform_of(const NMR::MODELTRANSFORM& field, double unit) {
    Transform map;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            map.linear[row][column] = double{field.m_fFields[row][column]};
        map.offset[row] = double{field.m_fFields[row][3]} * unit;
    }
    return map;
}

/// Reads a file by lib3mf. Objects of its interface are left to the end of the program.
class ConsortiumReader {
  public:
    /// None when it refuses the file.
    std::optional<Sum> read(const std::string& path) {
        NMR::PLib3MFModelReader* reader = nullptr;
        if (NMR::lib3mf_createmodel(&model_) != 0 ||
            NMR::lib3mf_model_queryreader(model_, "3mf", &reader) != 0 ||
            NMR::lib3mf_reader_readfromfileutf8(reader, path.c_str()) != 0)
            return std::nullopt;
        DWORD unit = 0;
        NMR::lib3mf_model_getunit(model_, &unit);
        unit_ = std::array{0.001, 1.0, 10.0, 25.4, 304.8, 1000.0}.at(unit);
        NMR::PLib3MFModelBuildItemIterator* items = nullptr;
        NMR::lib3mf_model_getbuilditems(model_, &items);
        BOOL more = 0;
        while (NMR::lib3mf_builditemiterator_movenext(items, &more) == 0 && more != 0) {
            NMR::PLib3MFModelBuildItem* item = nullptr;
            NMR::MODELTRANSFORM transform;
            DWORD id = 0;
            NMR::lib3mf_builditemiterator_getcurrent(items, &item);
            NMR::lib3mf_builditem_getobjecttransform(item, &transform);
            NMR::lib3mf_builditem_getobjectresourceid(item, &id);
            add(id, transform_of(transform, unit_));
        }
        return sum_;
    }

  private:
    void add(DWORD id, const Transform& placement) {
        NMR::PLib3MFModelComponentsObject* assembly = nullptr;
        if (NMR::lib3mf_model_getcomponentsobjectbyid(model_, id, &assembly) == 0 && assembly != nullptr) {
            DWORD count = 0;
            NMR::lib3mf_componentsobject_getcomponentcount(assembly, &count);
            for (DWORD i = 0; i < count; ++i) {
                NMR::PLib3MFModelComponent* component = nullptr;
                NMR::MODELTRANSFORM transform;
                DWORD inner = 0;
                NMR::lib3mf_componentsobject_getcomponent(assembly, i, &component);
                NMR::lib3mf_component_gettransform(component, &transform);
                NMR::lib3mf_component_getobjectresourceid(component, &inner);
                add(inner, compose(placement, transform_of(transform, unit_)));
            }
            return;
        }
        NMR::PLib3MFModelMeshObject* object = nullptr;
        if (NMR::lib3mf_model_getmeshobjectbyid(model_, id, &object) != 0)
            return;
        DWORD vertices = 0;
        DWORD triangles = 0;
        NMR::lib3mf_meshobject_getvertexcount(object, &vertices);
        NMR::lib3mf_meshobject_gettrianglecount(object, &triangles);
        IndexedMesh mesh;
        for (DWORD i = 0; i < vertices; ++i) {
            NMR::MODELMESHVERTEX vertex;
            NMR::lib3mf_meshobject_getvertex(object, i, &vertex);
            mesh.vertices.push_back({double{vertex.m_fPosition[0]}, double{vertex.m_fPosition[1]},
                                     double{vertex.m_fPosition[2]}});
        }
        for (DWORD i = 0; i < triangles; ++i) {
            NMR::MODELMESHTRIANGLE triangle;
            NMR::lib3mf_meshobject_gettriangle(object, i, &triangle);
            mesh.triangles.push_back(
                {triangle.m_nIndices[0], triangle.m_nIndices[1], triangle.m_nIndices[2]});
        }
        sum_.add(Mesh(std::move(mesh)).transformed(compose(placement, scaling(unit_, unit_, unit_))));
    }

    NMR::PLib3MFModel* model_ = nullptr;
    double unit_ = 1;
    Sum sum_;
};

TEST(Lib3mf, AgreesOnAllSamplesThatBothRead) {
    const std::filesystem::path top = std::filesystem::path(LAMELLA_SHARED) / "formats/samples";
    if (!std::filesystem::exists(top))
        GTEST_SKIP() << "no samples in " << LAMELLA_SHARED;
    std::size_t compared = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(top)) {
        const std::string path = entry.path().string();
        if (entry.path().extension() != ".3mf")
            continue;
        MeshFile file;
        try {
            file = read_mesh(path);
        } catch (const Error& error) {
            continue;
        }
        const auto theirs = ConsortiumReader().read(path);
        // It reads supports, too.
        if (!theirs || path.find("ExplicitSupport") != std::string::npos)
            continue;
        Sum ours;
        for (std::size_t i = 0; i < file.instances.size(); ++i)
            ours.add(file.placed(i));
        EXPECT_EQ(ours.triangles, theirs->triangles) << path;
        EXPECT_EQ(ours.meshes, theirs->meshes) << path;
        // lib3mf keeps single precision.
        const Point3 size{theirs->box.max.x, theirs->box.max.y, theirs->box.max.z};
        const double tolerance = 1e-5 * (std::abs(size.x) + std::abs(size.y) + std::abs(size.z));
        EXPECT_NEAR(ours.volume, theirs->volume, 1e-4 * std::abs(theirs->volume)) << path;
        for (const auto member : {&Point3::x, &Point3::y, &Point3::z}) {
            EXPECT_NEAR(ours.box.min.*member, theirs->box.min.*member, tolerance) << path;
            EXPECT_NEAR(ours.box.max.*member, theirs->box.max.*member, tolerance) << path;
        }
        ++compared;
    }
    EXPECT_GE(compared, 30U);
}

} // namespace
} // namespace lamella
