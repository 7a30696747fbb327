// Reads a 3MF file with the consortium's library and prints the seconds from file to the library's model, and
// the triangles, as JSON. Taking the mesh out of the model, one vertex at a time, is not counted.

#include <Model/COM/NMR_DLLInterfaces.h>

#include <chrono>
#include <cstdio>
#include <string_view>

namespace {

unsigned long long count_triangles(NMR::PLib3MFModel* model) {
    unsigned long long all = 0;
    NMR::PLib3MFModelResourceIterator* objects = nullptr;
    NMR::lib3mf_model_getmeshobjects(model, &objects);
    BOOL more = 0;
    while (NMR::lib3mf_resourceiterator_movenext(objects, &more) == 0 && more != 0) {
        NMR::PLib3MFModelResource* object = nullptr;
        DWORD triangles = 0;
        NMR::lib3mf_resourceiterator_getcurrent(objects, &object);
        NMR::lib3mf_meshobject_gettrianglecount(object, &triangles);
        all += triangles;
    }
    return all;
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2)
        return 2;
    if (std::string_view(argv[1]) == "--version") {
        DWORD major = 0;
        DWORD minor = 0;
        DWORD micro = 0;
        NMR::lib3mf_getinterfaceversion(&major, &minor, &micro);
        std::printf("%u.%u.%u\n", unsigned{major}, unsigned{minor}, unsigned{micro});
        return 0;
    }
    const auto start = std::chrono::steady_clock::now();
    NMR::PLib3MFModel* model = nullptr;
    NMR::PLib3MFModelReader* reader = nullptr;
    if (NMR::lib3mf_createmodel(&model) != 0 || NMR::lib3mf_model_queryreader(model, "3mf", &reader) != 0 ||
        NMR::lib3mf_reader_readfromfileutf8(reader, argv[1]) != 0) {
        std::fputs("lib3mf refuses the file\n", stderr);
        return 1;
    }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    std::printf("{\"seconds\": %.9f, \"triangles\": %llu}\n", seconds.count(), count_triangles(model));
    return 0;
}
