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
   throws, prints or ends the process. Handles are immutable, and any number of threads may use them at once.
   Each handle must be freed once, in any order: a result does not need the handle that it was made from.

   Each struct begins with its size, which the caller sets:

       lamella_settings settings = {.size = sizeof settings};

   A field that is zero stands for its default. The binary interface is stable: as long as lamella_abi() is
   the same, functions are only added, structs only get new fields at their end, and values of enums do not
   change. The number is also in the name of the shared library, liblamella-c.so.1, so programs need not be
   linked again for a new version of Lamella. */
#ifndef LAMELLA_C_H
#define LAMELLA_C_H

#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32) && defined(LAMELLA_C_DLL) /* only while the library is built; callers need no import */
#define LAMELLA_C_API __declspec(dllexport)
#elif defined(__GNUC__) && !defined(_WIN32)
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

typedef struct lamella_bytes lamella_bytes;

/* Settings of a call. Null may be passed instead of a pointer to settings. No setting changes a result. */
typedef struct lamella_settings {
    size_t size;         /* sizeof(lamella_settings) */
    uint32_t threads;    /* 0: one for each processor */
    uint64_t max_memory; /* limit on the memory for reading, in bytes; does not apply to binary STL; 0: three
                            quarters of the machine's memory */
    /* If set, called from time to time, by one thread at a time, but not always by the same one. A result
       other than 0 stops the call with LAMELLA_CANCELLED. `stage` is "read", "weld", "link", "slice",
       "polygon" or "write". */
    int (*progress)(void* user, const char* stage, uint64_t done, uint64_t total);
    /* If set, Lamella starts no threads and calls this function instead. It must call task(data, i) exactly
       once for every i < tasks, on any threads and in any order, and return when all calls have returned. */
    void (*run_tasks)(void* user, uint32_t tasks, void (*task)(void* data, uint32_t number), void* data);
    void* user; /* passed to both functions */
} lamella_settings;

/* The result for a plane that passes through vertices: the section just above it or just below it. */
typedef enum lamella_rule { LAMELLA_SECTION_ABOVE = 0, LAMELLA_SECTION_BELOW = 1 } lamella_rule;

/* Position of the cut within each layer. Cuts at the top use LAMELLA_SECTION_BELOW, others
   LAMELLA_SECTION_ABOVE. */
typedef enum lamella_cut { LAMELLA_CUT_MIDDLE = 0, LAMELLA_CUT_BOTTOM = 1, LAMELLA_CUT_TOP = 2 } lamella_cut;

/* Where to cut a mesh. */
typedef struct lamella_plan {
    size_t size;               /* sizeof(lamella_plan) */
    double layer_height;       /* 0: 0.1 */
    double first_layer_height; /* 0: that of the other layers */
    lamella_cut cut;
    double snap; /* vertices at most this far from a plane count as on it */
    /* If max_height is above 0, layers are adaptive: their heights are between min_height and max_height, and
       as large as possible while steps deviate from the surface by at most `cusp` (0: 0.05). */
    double min_height;
    double max_height;
    double cusp;
} lamella_plan;

/* How to repair a mesh, in this order. */
typedef struct lamella_mending {
    size_t size;           /* sizeof(lamella_mending) */
    double weld_tolerance; /* joins vertices at most this far apart, the closest pairs first; 0: none */
    int drop_duplicates;   /* keeps one of several triangles with the same corners; opposite pairs cancel */
    int orient;            /* flips triangles so that neighbours agree and bodies face outwards */
} lamella_mending;

/* Numbers of changes by lamella_mend. */
typedef struct lamella_mended {
    size_t size; /* sizeof(lamella_mended) */
    uint64_t joined_vertices;
    uint64_t collapsed_triangles; /* dropped, because their corners were joined */
    uint64_t repeated_triangles;  /* dropped */
    uint64_t opposite_triangles;  /* dropped in pairs */
    uint64_t flipped_triangles;
} lamella_mended;

/* How lamella_offset joins moved sides that separate at a corner. */
typedef enum lamella_join { LAMELLA_MITRE = 0, LAMELLA_BEVEL = 1, LAMELLA_ROUND = 2 } lamella_join;

typedef struct lamella_corners {
    size_t size; /* sizeof(lamella_corners) */
    lamella_join join;
    double mitre_limit;   /* mitres longer than this many offset distances are cut off; 0: 2 */
    double arc_tolerance; /* largest distance of chords from their arc; 0: 0.001 */
} lamella_corners;

/* What the result of lamella_combine contains: the material in either layer, in both, in the first one only,
   or in exactly one. */
typedef enum lamella_operation {
    LAMELLA_UNION = 0,
    LAMELLA_INTERSECTION = 1,
    LAMELLA_DIFFERENCE = 2,
    LAMELLA_EXCLUSION = 3
} lamella_operation;

/* One layer. Contour i has the points [offsets[i], offsets[i + 1]). The first `rings` contours are closed,
   and their first point is not repeated; the others are open chains, caused by holes in the mesh. Material is
   to the left of each contour. The arrays are valid until the layers are freed. */
typedef struct lamella_layer {
    size_t size;    /* sizeof(lamella_layer) */
    uint64_t index; /* its number in the whole plan */
    double z;       /* height of the cut */
    double bottom;  /* bottom and top of the material that it represents */
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
/* One line about the last failed call of this thread, or "" if none has failed. The pointer is valid until
   the thread's next call. */
LAMELLA_C_API const char* lamella_error(void);
/* The warnings of the last call of this thread, one per line; valid until its next call; "" if there are
   none. */
LAMELLA_C_API const char* lamella_warnings(void);

/* Reads all meshes of a file as one mesh. */
LAMELLA_C_API lamella_status lamella_read_mesh(const char* path, const lamella_settings* settings,
                                               lamella_mesh** mesh);
/* Reads a mesh from the contents of a file in memory; `name` is used in error messages. */
LAMELLA_C_API lamella_status lamella_read_mesh_bytes(const void* bytes, size_t size, const char* name,
                                                     const lamella_settings* settings, lamella_mesh** mesh);
/* Copies arrays: x, y and z of each vertex, and three indices for each triangle, counter-clockwise seen
 * from outside. */
LAMELLA_C_API lamella_status lamella_make_mesh(const double* vertices, size_t vertex_count,
                                               const uint32_t* triangles, size_t triangle_count,
                                               lamella_mesh** mesh);
/* Makes a mesh with each vertex p moved to M p + t; `matrix` has the rows of (M | t), 12 numbers. */
LAMELLA_C_API lamella_status lamella_transform_mesh(const lamella_mesh* mesh, const double* matrix,
                                                    lamella_mesh** transformed);
/* Repairs a mesh, each of its bodies by itself. `counts` gets the changes; it may be null. */
LAMELLA_C_API lamella_status lamella_mend(const lamella_mesh* mesh, const lamella_mending* mending,
                                          const lamella_settings* settings, lamella_mended* counts,
                                          lamella_mesh** mended);
/* Returns 0 for a null pointer. */
LAMELLA_C_API size_t lamella_triangle_count(const lamella_mesh* mesh);
/* Sets 6 numbers: the smallest x, y and z, then the largest. */
LAMELLA_C_API lamella_status lamella_mesh_box(const lamella_mesh* mesh, double* box);
LAMELLA_C_API void lamella_free_mesh(lamella_mesh* mesh);

/* Cuts the mesh into layers of this height. Each layer is cut in its middle. */
LAMELLA_C_API lamella_status lamella_slice(const lamella_mesh* mesh, double layer_height,
                                           const lamella_settings* settings, lamella_layers** layers);
/* Cuts the mesh at these heights, which must ascend. */
LAMELLA_C_API lamella_status lamella_slice_at(const lamella_mesh* mesh, const double* heights, size_t count,
                                              const lamella_settings* settings, lamella_layers** layers);
/* Cuts the mesh by a plan. */
LAMELLA_C_API lamella_status lamella_slice_by_plan(const lamella_mesh* mesh, const lamella_plan* plan,
                                                   const lamella_settings* settings, lamella_layers** layers);

/* Prepares a mesh for many single planes. The cost of a plane then depends mainly on the number of triangles
   that it cuts. */
LAMELLA_C_API lamella_status lamella_prepare(const lamella_mesh* mesh, lamella_rule rule,
                                             const lamella_settings* settings, lamella_slicer** slicer);
/* Computes the section at a height, as one layer. */
LAMELLA_C_API lamella_status lamella_section(const lamella_slicer* slicer, double z, lamella_layers** layers);
/* Computes the section with the plane through `origin` perpendicular to `normal`, three numbers each, as one
   layer in coordinates within the plane. `to_mesh` gets 12 numbers, the rows of a matrix that maps (x, y, 0)
   to the mesh; it may be null. */
LAMELLA_C_API lamella_status lamella_section_of_plane(const lamella_slicer* slicer, const double* origin,
                                                      const double* normal, double* to_mesh,
                                                      lamella_layers** layers);
LAMELLA_C_API void lamella_free_slicer(lamella_slicer* slicer);

/* Reads a slice file; the contours of several parts become one layer on each plane, and a warning reports
   it. */
LAMELLA_C_API lamella_status lamella_read_layers(const char* path, const lamella_settings* settings,
                                                 lamella_layers** layers);
/* Reads layers from the contents of a slice file in memory; `name` is used in error messages. */
LAMELLA_C_API lamella_status lamella_read_layers_bytes(const void* bytes, size_t size, const char* name,
                                                       const lamella_settings* settings,
                                                       lamella_layers** layers);
/* Copies one layer; its contours may be in any order. `area_mm2` is ignored. */
LAMELLA_C_API lamella_status lamella_make_layer(const lamella_layer* layer, lamella_layers** layers);
/* Writes a slice file. `format` is a name such as "cli"; null: by the extension of the path. */
LAMELLA_C_API lamella_status lamella_write_layers(const lamella_layers* layers, const char* path,
                                                  const char* format, const lamella_settings* settings);
/* Writes a slice file to memory. */
LAMELLA_C_API lamella_status lamella_write_layers_bytes(const lamella_layers* layers, const char* format,
                                                        const lamella_settings* settings,
                                                        lamella_bytes** bytes);
/* Return null and 0 for a null pointer. */
LAMELLA_C_API const void* lamella_bytes_data(const lamella_bytes* bytes);
LAMELLA_C_API size_t lamella_bytes_size(const lamella_bytes* bytes);
LAMELLA_C_API void lamella_free_bytes(lamella_bytes* bytes);
/* Returns 0 for a null pointer. */
LAMELLA_C_API size_t lamella_layer_count(const lamella_layers* layers);
LAMELLA_C_API lamella_status lamella_get_layer(const lamella_layers* layers, size_t number,
                                               lamella_layer* layer);
/* Sets for each contour of a layer the number of the innermost ring around it: -1 for an outermost ring and
   for an open chain. A hole is cut out of the ring around it. `parents` has room for all contours. */
LAMELLA_C_API lamella_status lamella_ring_parents(const lamella_layers* layers, size_t number,
                                                  int64_t* parents);

/* Joins ends of open chains that are at most `distance` apart, the closest pairs first. `closed` gets the
   number of joins; it may be null. */
LAMELLA_C_API lamella_status lamella_close_gaps(const lamella_layers* layers, double distance,
                                                const lamella_settings* settings, uint64_t* closed,
                                                lamella_layers** result);
/* Grows the material by this distance, or shrinks it if the distance is negative. `corners` may be null. */
LAMELLA_C_API lamella_status lamella_offset(const lamella_layers* layers, double distance,
                                            const lamella_corners* corners, const lamella_settings* settings,
                                            lamella_layers** result);
/* Combines the first layers of both, the second layers of both, and so on. Both must have the same number of
   layers. Heights and open chains are those of `first`. */
LAMELLA_C_API lamella_status lamella_combine(const lamella_layers* first, const lamella_layers* second,
                                             lamella_operation operation, const lamella_settings* settings,
                                             lamella_layers** result);
LAMELLA_C_API void lamella_free_layers(lamella_layers* layers);

#ifdef __cplusplus
}
#endif

#endif
