/* Lamella for other languages: opaque handles, statuses, and arrays as pointers and counts.

       lamella_mesh *mesh;
       lamella_layers *layers;
       if (lamella_read_mesh("part.stl", NULL, &mesh) != LAMELLA_OK)
           return fail(lamella_error());
       if (lamella_slice(mesh, 0.1, NULL, &layers) == LAMELLA_OK) {
           lamella_write_layers(layers, "part.cli", NULL, NULL);
           lamella_free_layers(layers);
       }
       lamella_free_mesh(mesh);

   Lengths are millimetres. Texts are UTF-8. A function that fails changes none of its results. No function
   throws, prints or ends the process. Handles are immutable, and any number of threads may use them at once;
   free each of them once, in any order: a result does not need the handle it was made from.

   The binary interface is stable: with the same lamella_abi(), functions are only added, and neither
   functions, structs nor values of enums change. */
#ifndef LAMELLA_C_H
#define LAMELLA_C_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__) && !defined(_WIN32)
#define LAMELLA_C_API __attribute__((visibility("default")))
#else
#define LAMELLA_C_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* The version of the binary interface that this header describes. */
#define LAMELLA_ABI 1

/* Values of 2 to 6 are the exit codes of the program `lamella`. */
typedef enum lamella_status {
    LAMELLA_OK = 0,
    LAMELLA_INTERNAL = 1,  /* an error in Lamella itself; please report it */
    LAMELLA_USAGE = 2,     /* arguments that cannot be satisfied, such as a null pointer */
    LAMELLA_INPUT = 3,     /* a file that cannot be read or holds nothing to slice */
    LAMELLA_DEFECT = 4,    /* a defect of the mesh or the layers */
    LAMELLA_LIMIT = 5,     /* more memory or larger numbers than allowed */
    LAMELLA_OUTPUT = 6,    /* a file that cannot be written; nothing was left at its path */
    LAMELLA_CANCELLED = 7, /* the progress function asked to stop */
    LAMELLA_NO_MEMORY = 8
} lamella_status;

typedef struct lamella_mesh lamella_mesh;
typedef struct lamella_layers lamella_layers;
typedef struct lamella_slicer lamella_slicer;

/* Where settings are taken, a null pointer stands for a struct of zeros. No setting changes a result. */
typedef struct lamella_settings {
    uint32_t threads;    /* 0: one for each processor */
    uint64_t max_memory; /* bytes that reading may take, not counted for binary STL; 0: three quarters of the
                            memory */
    /* Called from time to time, from one thread at a time, but not always from the same one. Another result
       than 0 stops the call with LAMELLA_CANCELLED. `stage` is "read", "weld", "link", "slice" or "write".
       May be null. */
    int (*progress)(void* user, const char* stage, uint64_t done, uint64_t total);
    /* Runs tasks on threads of the caller, and no thread is started then: must call task(data, i) once for
       each i < tasks, on any threads, also one after the other, and return when all have returned. May be
       null. */
    void (*run_tasks)(void* user, uint32_t tasks, void (*task)(void* data, uint32_t number), void* data);
    void* user; /* passed to both functions */
} lamella_settings;

/* One layer. Contour i has the points [offsets[i], offsets[i + 1]). The first `rings` contours are closed,
   and their first point is not repeated; the others are open chains, the traces of defects. Material is to
   the left of each contour. The arrays live as long as the layers they are part of. */
typedef struct lamella_layer {
    uint64_t index; /* its number in the whole plan */
    double z;       /* height of the cut */
    double bottom;  /* bottom and top of the material it stands for */
    double top;
    const double* points; /* x and y of each point */
    size_t point_count;
    const uint64_t* offsets; /* contour_count + 1 of them, counted in points */
    size_t contour_count;
    size_t rings;
    double area_mm2; /* of the rings, holes subtracted */
} lamella_layer;

/* The version of the binary interface of the library, and that of the library. */
LAMELLA_C_API uint32_t lamella_abi(void);
LAMELLA_C_API const char* lamella_version(void);
/* One line about the last call of this thread that failed, valid until its next call; "" if none has failed.
 */
LAMELLA_C_API const char* lamella_error(void);
/* What the last call of this thread has to warn of, a line each, valid until its next call; "" if there is
 * nothing. */
LAMELLA_C_API const char* lamella_warnings(void);

/* Reads all meshes of a file, as one. */
LAMELLA_C_API lamella_status lamella_read_mesh(const char* path, const lamella_settings* settings,
                                               lamella_mesh** mesh);
/* Reads a copy of a file in memory; `name` stands in errors. */
LAMELLA_C_API lamella_status lamella_read_mesh_bytes(const void* bytes, size_t size, const char* name,
                                                     const lamella_settings* settings, lamella_mesh** mesh);
/* Copies arrays: x, y and z of each vertex, and three indices for each triangle, counter-clockwise from
 * outside. */
LAMELLA_C_API lamella_status lamella_make_mesh(const double* vertices, size_t vertex_count,
                                               const uint32_t* triangles, size_t triangle_count,
                                               lamella_mesh** mesh);
/* The mesh after p' = M p + t; `matrix` has the rows of (M | t), 12 numbers. */
LAMELLA_C_API lamella_status lamella_transform_mesh(const lamella_mesh* mesh, const double* matrix,
                                                    lamella_mesh** transformed);
/* 0 for a null pointer. */
LAMELLA_C_API size_t lamella_triangle_count(const lamella_mesh* mesh);
/* Sets 6 numbers: the least x, y and z, and the largest. */
LAMELLA_C_API lamella_status lamella_mesh_box(const lamella_mesh* mesh, double* box);
LAMELLA_C_API void lamella_free_mesh(lamella_mesh* mesh);

/* Cuts the mesh into layers of this height, each in its middle. */
LAMELLA_C_API lamella_status lamella_slice(const lamella_mesh* mesh, double layer_height,
                                           const lamella_settings* settings, lamella_layers** layers);
/* Cuts the mesh at these heights, which must ascend. */
LAMELLA_C_API lamella_status lamella_slice_at(const lamella_mesh* mesh, const double* heights, size_t count,
                                              const lamella_settings* settings, lamella_layers** layers);

/* Prepares a mesh for many single planes: each then costs in proportion to the triangles that it cuts. */
LAMELLA_C_API lamella_status lamella_prepare(const lamella_mesh* mesh, const lamella_settings* settings,
                                             lamella_slicer** slicer);
/* The section at a height, as one layer. */
LAMELLA_C_API lamella_status lamella_section(const lamella_slicer* slicer, double z, lamella_layers** layers);
/* The section with the plane through `origin` at right angles to `normal`, three numbers each, as one layer
   in coordinates within the plane. `to_mesh` gets 12 numbers, the rows of a matrix that maps (x, y, 0) to the
   mesh; it may be null. */
LAMELLA_C_API lamella_status lamella_section_of_plane(const lamella_slicer* slicer, const double* origin,
                                                      const double* normal, double* to_mesh,
                                                      lamella_layers** layers);
LAMELLA_C_API void lamella_free_slicer(lamella_slicer* slicer);

/* Reads a slice file; the contours of several parts become one layer on each plane, and a warning tells it.
 */
LAMELLA_C_API lamella_status lamella_read_layers(const char* path, const lamella_settings* settings,
                                                 lamella_layers** layers);
/* Writes a slice file. `format` is a name such as "cli"; null: by the extension of the path. */
LAMELLA_C_API lamella_status lamella_write_layers(const lamella_layers* layers, const char* path,
                                                  const char* format, const lamella_settings* settings);
/* 0 for a null pointer. */
LAMELLA_C_API size_t lamella_layer_count(const lamella_layers* layers);
LAMELLA_C_API lamella_status lamella_get_layer(const lamella_layers* layers, size_t number,
                                               lamella_layer* layer);
LAMELLA_C_API void lamella_free_layers(lamella_layers* layers);

#ifdef __cplusplus
}
#endif

#endif
