/**
 * @file hairmesh.h
 * Hair mesh simulation for programs in any language: a C99 interface to the simulator and to the strands.
 *
 * A hair mesh (hm_mesh) is immutable; any number of hairs (hm_hair) share one. A hair has parameters and a state, and is
 * advanced step by step with the roots and colliders of each step's end. Its strands are grown from the state when they
 * are asked for; nothing is stored per strand.
 *
 * Units: SI, radians. Axes: y up, right-handed; a hair mesh is in the head's frame, all else in the world's.
 *
 * Results: every function that can fail returns an hm_result; hm_error_message() says what was wrong and what would mend
 * it. A call that fails changes nothing, but for hm_hair_step running out of memory. Pointers that a function cannot do
 * without are checked for NULL.
 *
 * Handles: plain numbers. One that was destroyed, never made, or is of another kind is answered with HM_ERROR_HANDLE,
 * for the life of the process.
 *
 * Threads: calls for different hairs may run at the same time, hairs of one mesh included. A call for a hair that another
 * thread is working on is refused with HM_ERROR_BUSY. hm_set_log and hm_set_allocator are for the start of a program.
 *
 * Layout: structures and functions keep their layout as long as the library's SONAME stays. Fill every settings
 * structure by its hm_default_ function first.
 */
#ifndef HAIRMESH_H
#define HAIRMESH_H

#include <stddef.h>
#include <stdint.h>

/** Version of this header: major number. */
#define HM_VERSION_MAJOR 0
/** Version of this header: minor number; as long as the major number is 0, another one is another SONAME. */
#define HM_VERSION_MINOR 1
/** Version of this header: patch number. */
#define HM_VERSION_PATCH 0

/** Marks the functions of the library. */
#if defined(__GNUC__)
#define HM_API __attribute__((visibility("default")))
#else
#define HM_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/** What became of a call. */
typedef enum hm_result {
  HM_OK = 0,                /**< Done. */
  HM_ERROR_ARGUMENT = 1,    /**< A pointer is NULL, an index or a count is out of range. */
  HM_ERROR_HANDLE = 2,      /**< The handle's object is destroyed, was never made, or is of another kind. */
  HM_ERROR_BUSY = 3,        /**< Another thread is working on this hair. */
  HM_ERROR_SIZE = 4,        /**< An array has another number of elements than is needed. */
  HM_ERROR_VALUE = 5,       /**< A number is not finite or out of its range. */
  HM_ERROR_NAME = 6,        /**< No parameter has this name. */
  HM_ERROR_MESH = 7,        /**< The hair mesh cannot be simulated. */
  HM_ERROR_TEXT = 8,        /**< The text cannot be read as a hair mesh. */
  HM_ERROR_STATE = 9,       /**< The bytes are no state of this hair mesh and version. */
  HM_ERROR_MEMORY = 10,     /**< There is not enough memory. */
  HM_ERROR_UNSUPPORTED = 11, /**< This build of the library cannot do that. */
  HM_ERROR_INTERNAL = 12    /**< A fault of the library's own: please report it. */
} hm_result;

/** A hair mesh. {0} is none. */
typedef struct hm_mesh {
  uint64_t id; /**< Number of the object; 0: none. */
} hm_mesh;

/** A hair. {0} is none. */
typedef struct hm_hair {
  uint64_t id; /**< Number of the object; 0: none. */
} hm_hair;

/** Numbers of an array. */
typedef enum hm_type {
  HM_FLOAT64 = 0, /**< double */
  HM_FLOAT32 = 1  /**< float */
} hm_type;

/** An array of the caller's that is read: `count` elements of three numbers each, `stride` bytes apart. */
typedef struct hm_array {
  const void* data; /**< First number of the first element; NULL where there is none. */
  size_t stride;    /**< Bytes from one element to the next, at least its size; 0: they lie side by side. */
  size_t count;     /**< Elements. */
  hm_type type;     /**< Of the numbers. */
} hm_array;

/** An array of the caller's that is written: `count` elements, `stride` bytes apart. */
typedef struct hm_target {
  void* data;    /**< First number of the first element; NULL where it is not wanted. */
  size_t stride; /**< Bytes from one element to the next, at least its size; 0: they lie side by side. */
  size_t count;  /**< Elements that there is room for. */
  hm_type type;  /**< Of the numbers. */
} hm_target;

/** An array of the library's: `count` elements of three doubles each, `stride` bytes apart. */
typedef struct hm_view {
  const double* data; /**< First number of the first element. */
  size_t stride;      /**< Bytes from one element to the next. */
  size_t count;       /**< Elements. */
} hm_view;

/** A rigid placement: p goes to rotation * p + position. */
typedef struct hm_pose {
  double position[3]; /**< m */
  double rotation[4]; /**< Unit quaternion x, y, z, w; its norm may be off by 1e-4. */
} hm_pose;

/* ---- the library ------------------------------------------------------------------------------------------------ */

/** Tells the version of the library that is linked. @return major * 10000 + minor * 100 + patch. */
HM_API int32_t hm_version(void);

/** Name of a result, as "HM_ERROR_SIZE". @param result of a call. @return text that stays. */
HM_API const char* hm_result_name(hm_result result);

/**
 * What was wrong in this thread's last call that failed, and what would mend it, in one line.
 * @return text that stays until another call of this thread fails; "" before the first one.
 */
HM_API const char* hm_error_message(void);

/** Weight of a line of the log. */
typedef enum hm_log_level {
  HM_LOG_NOTE = 0,    /**< Something that may be of use. */
  HM_LOG_WARNING = 1, /**< Something was repaired or left out, or is hardly meant: hair longer than 3 m. */
  HM_LOG_ERROR = 2    /**< A call failed; its message. */
} hm_log_level;

/** Takes a line of the log: its weight, its text without the line's end, and the pointer given to hm_set_log. */
typedef void (*hm_log)(hm_log_level level, const char* message, void* user);

/**
 * Gives the log to a function of the caller's. It is called in the thread whose call has something to say, and must not
 * call the library.
 * @param log  NULL: no log, as at first.
 * @param user handed on to `log`.
 */
HM_API void hm_set_log(hm_log log, void* user);

/** Functions of the caller's that give memory. They are called from every thread that calls the library, and must not call
 * it. */
typedef struct hm_allocator {
  void* (*allocate)(size_t size, size_t alignment, void* user); /**< `size` bytes at a multiple of `alignment`, a power
                                                                   of two; NULL where there are none. */
  void (*release)(void* block, size_t size, void* user);        /**< Takes a block of `allocate` back. */
  void* user;                                                   /**< Handed on to both. */
} hm_allocator;

/**
 * Takes all later memory from the caller.
 *
 * Covered in the shared library on Linux: every block that the library, the C++ runtime inside it or Eigen takes from
 * malloc, in any thread. Not covered: what the C library takes for itself, and stacks. A block goes back to the allocator
 * that it came from, so that it can be set at any time. When all meshes and hairs are destroyed, nothing of it is left.
 * The static library shares malloc with its program and cannot tell them apart.
 * @param allocator copied; NULL: malloc, as at first.
 * @return HM_ERROR_UNSUPPORTED in the static library and in builds for sanitizers.
 */
HM_API hm_result hm_set_allocator(const hm_allocator* allocator);

/* ---- hair meshes ------------------------------------------------------------------------------------------------ */

/** A hair mesh as arrays. */
typedef struct hm_mesh_settings {
  hm_array positions;            /**< m, the vertices at rest, column after column, each from root to tip. */
  const int32_t* column_lengths; /**< Vertices of every column, at least 2. */
  size_t column_count;           /**< Columns. */
  const int32_t* faces;          /**< Root faces, four columns each, counter-clockwise seen from outside the scalp; the
                                      fourth is -1 in a triangle. */
  size_t face_count;             /**< Root faces. */
  int32_t reverse_faces;         /**< 1: all faces are wound the other way. */
} hm_mesh_settings;

/** What a hair mesh is. Its pointers stay as long as the mesh is not destroyed. */
typedef struct hm_mesh_info {
  int32_t vertex_count;        /**< Vertices. */
  int32_t column_count;        /**< Columns. */
  int32_t face_count;          /**< Root faces. */
  int32_t layer_count;         /**< Vertices of the longest column. */
  double hair_length;          /**< m, rest length of the longest column. */
  double volume;               /**< m^3 */
  const int32_t* column_first; /**< First vertex of every column, and the number of vertices after the last. */
  const int32_t* faces;        /**< As in hm_mesh_settings. */
  hm_view rest;                /**< m, vertices at rest. */
} hm_mesh_info;

/** Fills the settings with what they are where nothing else is said: no vertices. @param settings to fill. */
HM_API void hm_default_mesh_settings(hm_mesh_settings* settings);

/**
 * Makes a hair mesh from arrays, which are copied.
 * @param settings the mesh.
 * @param mesh     the new mesh.
 * @return HM_ERROR_MESH with the place, the fault and the mend.
 */
HM_API hm_result hm_mesh_create(const hm_mesh_settings* settings, hm_mesh* mesh);

/**
 * Makes a hair mesh from the text of an OBJ file: one group a layer, layer_0 the scalp.
 * @param text          need not end with a zero.
 * @param length        bytes of it.
 * @param name          names the text in messages; NULL: "hair mesh".
 * @param reverse_faces 1: all faces are wound the other way.
 * @param mesh          the new mesh.
 * @return HM_ERROR_TEXT with the line, the fault and the mend.
 */
HM_API hm_result hm_mesh_create_from_text(const char* text, size_t length, const char* name, int32_t reverse_faces,
                                          hm_mesh* mesh);

/**
 * Makes a hair mesh of a built-in style on a plain head: an ellipsoid about the origin of radii 0.34, 0.5 and 0.42 of its
 * height in x, y and z, to be given to steps as an hm_ellipsoid. y is up, z forward. Takes up to a second and a half.
 * @param style       "short", "shoulder", "long", "bob", "pixie" or "shaved".
 * @param resolution  "low", "medium", "high" or "ultra".
 * @param head_height chin to crown, m: 0.05 to 2; 0.23 is a person's.
 * @param mesh        the new mesh.
 * @return HM_ERROR_ARGUMENT with the names there are, HM_ERROR_VALUE of a height beyond its range.
 */
HM_API hm_result hm_mesh_create_style(const char* style, const char* resolution, double head_height, hm_mesh* mesh);

/** Destroys a mesh. Hairs of it live on. @param mesh a mesh. @return HM_OK or HM_ERROR_HANDLE. */
HM_API hm_result hm_mesh_destroy(hm_mesh mesh);

/** Tells what a mesh is. @param mesh a mesh. @param info to fill. @return HM_OK or what was wrong. */
HM_API hm_result hm_mesh_describe(hm_mesh mesh, hm_mesh_info* info);

/* ---- parameters ------------------------------------------------------------------------------------------------- */

/** Kinds of a parameter. */
typedef enum hm_kind {
  HM_REAL = 0,    /**< A number. */
  HM_INTEGER = 1, /**< A whole number. */
  HM_SWITCH = 2,  /**< 0 or 1; as text off or on. */
  HM_CHOICE = 3   /**< Index of a choice; as text its name. */
} hm_kind;

/** One parameter. All texts stay. */
typedef struct hm_parameter {
  const char* name;           /**< As it is set by. */
  const char* group;          /**< What it belongs to. */
  const char* unit;           /**< "" where it has none. */
  const char* help;           /**< What it does. */
  hm_kind kind;               /**< Of its values. */
  double minimum;             /**< Least value. */
  double maximum;             /**< Largest value. */
  double default_value;       /**< What a new hair has. */
  int32_t logarithmic;        /**< 1: a slider should be logarithmic. */
  int32_t of_strands;         /**< 1: it changes strands, not the motion. */
  const char* const* choices; /**< Names of the choices. */
  int32_t choice_count;       /**< Number of choices. */
} hm_parameter;

/** Counts the parameters that a hair has. @return their number: those of the simulation, then those of the strands. */
HM_API int32_t hm_parameter_count(void);

/** Tells of a parameter. @param index 0 .. hm_parameter_count() - 1. @param parameter to fill. @return HM_OK or
 * HM_ERROR_ARGUMENT. */
HM_API hm_result hm_parameter_at(int32_t index, hm_parameter* parameter);

/** Tells of the parameter of a name. @param name of it. @param parameter to fill. @return HM_OK or HM_ERROR_NAME. */
HM_API hm_result hm_parameter_find(const char* name, hm_parameter* parameter);

/* ---- hairs ------------------------------------------------------------------------------------------------------ */

/** How a hair begins. */
typedef struct hm_hair_settings {
  hm_pose head;           /**< Of the head at the start: the hair is in its rest shape there. */
  int32_t measure_stages; /**< 1: hm_report has the seconds of each stage. */
  int32_t gradual;        /**< 1: what follows a changed parameter is made in slices over the next steps. */
} hm_hair_settings;

/** Fills the settings with what they are where nothing else is said. @param settings to fill. */
HM_API void hm_default_hair_settings(hm_hair_settings* settings);

/**
 * Makes a hair of a mesh, with the defaults of all parameters.
 * @param mesh     shared by any number of hairs.
 * @param settings NULL: the defaults.
 * @param hair     the new hair.
 * @return HM_OK or what was wrong.
 */
HM_API hm_result hm_hair_create(hm_mesh mesh, const hm_hair_settings* settings, hm_hair* hair);

/** Destroys a hair. @param hair a hair. @return HM_OK, HM_ERROR_HANDLE or HM_ERROR_BUSY. */
HM_API hm_result hm_hair_destroy(hm_hair hair);

/** Sets a parameter. @param hair a hair. @param name of the parameter. @param value within its range. @return HM_OK,
 * HM_ERROR_NAME, HM_ERROR_VALUE, or what else was wrong. */
HM_API hm_result hm_hair_set(hm_hair hair, const char* name, double value);

/** Sets a parameter from text: a number, on or off, or the name of a choice. @param hair a hair. @param name of the
 * parameter. @param value as text. @return as hm_hair_set. */
HM_API hm_result hm_hair_set_text(hm_hair hair, const char* name, const char* value);

/** Tells the value of a parameter. @param hair a hair. @param name of the parameter. @param value to fill. @return
 * HM_OK or what was wrong. */
HM_API hm_result hm_hair_get(hm_hair hair, const char* name, double* value);

/** Gives all parameters their defaults. @param hair a hair. @return HM_OK or what was wrong. */
HM_API hm_result hm_hair_reset_parameters(hm_hair hair);

/** A solid ellipsoid at its place at the end of a step, with the motion that brought it there. */
typedef struct hm_ellipsoid {
  hm_pose pose;               /**< Its centre and axes. */
  double radii[3];            /**< m, along its axes, above 0. */
  double velocity[3];         /**< m/s, of its centre. */
  double angular_velocity[3]; /**< rad/s, about the world's axes. */
} hm_ellipsoid;

/** Fills an ellipsoid with a ball of 1 m at rest at the origin. @param ellipsoid to fill. */
HM_API void hm_default_ellipsoid(hm_ellipsoid* ellipsoid);

/**
 * Gives an ellipsoid the velocities of the motion that brought it from another pose within a time.
 * @param ellipsoid at its pose now.
 * @param before    its pose then.
 * @param seconds   above 0.
 * @return HM_OK or what was wrong.
 */
HM_API hm_result hm_ellipsoid_moved(hm_ellipsoid* ellipsoid, const hm_pose* before, double seconds);

/** A vertex that is drawn to a point. */
typedef struct hm_pin {
  int32_t vertex;     /**< Of the mesh; no root. */
  double target[3];   /**< m, at the step's end. */
  double velocity[3]; /**< m/s, that brought it there. */
  double stiffness;   /**< N/m; infinite: the vertex ends the step on the target. */
} hm_pin;

/** What happens around a hair during a step. Poses are those of the step's end. */
typedef struct hm_step_input {
  double dt;                      /**< s, 1e-6 to 0.1. */
  double time;                    /**< s, of the step's end; gusts are a function of it. */
  hm_pose head;                   /**< Carries the roots, unless they are given. */
  hm_array roots;                 /**< m, one a column; no data: the roots at rest, carried by `head`. */
  const hm_ellipsoid* ellipsoids; /**< Colliders. */
  size_t ellipsoid_count;         /**< Number of colliders. */
  const hm_pin* pins;             /**< Pinned vertices. */
  size_t pin_count;               /**< Number of pins. */
  double max_work;                /**< Budget in units of work, about 0.04 microseconds each; infinite: none. */
} hm_step_input;

/** What a step did. */
typedef struct hm_report {
  int32_t solver_iterations; /**< Of all linear solves. */
  int32_t solves;            /**< Linear solves. */
  double residual;           /**< Relative, at the end of the last solve. */
  int32_t converged;         /**< 1: to the tolerance. */
  int32_t contacts;          /**< Vertices held by colliders. */
  int32_t corrected;         /**< Vertices moved by position correction. */
  double max_penetration;    /**< m, found before correction. */
  int32_t self_contacts;     /**< Vertices pushed out of other bundles. */
  int32_t guided;            /**< Columns guided to rest. */
  int32_t repaired;          /**< Vertices or states repaired; the log tells why. */
  int32_t carried;           /**< 1: the roots had jumped, and the hair was carried along. */
  int32_t pins;              /**< Pins that hold. */
  int32_t pins_out_of_reach; /**< Pins that have let go. */
  double work;               /**< Units of work done; see hm_step_input. */
  int32_t solve_cut;         /**< 1: the solve ended at the budget. */
  int32_t corrections_cut;   /**< 1: corrections ended at the budget; nothing is inside a collider. */
  double seconds[5];         /**< Of forces, solve, collision, minimization and the rest; 0 unless measured. */
} hm_report;

/** Fills the input with a step of 1/60 s without colliders, pins and budget. @param input to fill. */
HM_API void hm_default_step_input(hm_step_input* input);

/**
 * Advances a hair by one step. Takes no memory once it is warm.
 * @param hair   a hair.
 * @param input  the step; refused whole where a number of it is not finite or out of range.
 * @param report to fill; NULL: not wanted.
 * @return HM_OK or what was wrong.
 */
HM_API hm_result hm_hair_step(hm_hair hair, const hm_step_input* input, hm_report* report);

/** Puts a hair to its rest shape, at rest. @param hair a hair. @param head where the head is. @return HM_OK or what was
 * wrong. */
HM_API hm_result hm_hair_reset(hm_hair hair, const hm_pose* head);

/** Carries a hair along rigidly: a teleport that keeps its shape and motion. @param hair a hair. @param from pose of the
 * head before. @param to pose of the head now. @return HM_OK or what was wrong. */
HM_API hm_result hm_hair_carry(hm_hair hair, const hm_pose* from, const hm_pose* to);

/**
 * Writes all that changes from step to step. Steps that go on from it end in the same bits, on the same build and
 * processor, with the same input and parameters; parameters are not part of it.
 * @param hair     a hair.
 * @param buffer   NULL: only the size is told.
 * @param capacity bytes that the buffer has.
 * @param size     bytes that the state has.
 * @return HM_ERROR_SIZE where the buffer is too small; then `size` is filled.
 */
HM_API hm_result hm_hair_save(hm_hair hair, void* buffer, size_t capacity, size_t* size);

/** Restores what hm_hair_save wrote for a hair of the same mesh. @param hair a hair. @param bytes the state. @param size
 * of it, in bytes. @return HM_ERROR_STATE where the bytes are not what was saved. */
HM_API hm_result hm_hair_restore(hm_hair hair, const void* bytes, size_t size);

/** Shows the vertices' positions (m, world) where they lie. The place stays as long as the hair is not destroyed; steps
 * write to it. @param hair a hair. @param view to fill. @return HM_OK or what was wrong. */
HM_API hm_result hm_hair_positions(hm_hair hair, hm_view* view);

/** Shows the vertices' velocities (m/s) where they lie, as hm_hair_positions. @param hair a hair. @param view to fill.
 * @return HM_OK or what was wrong. */
HM_API hm_result hm_hair_velocities(hm_hair hair, hm_view* view);

/** Copies the vertices' positions (m, world), in either type and any stride. @param hair a hair. @param target room for
 * three numbers a vertex. @return HM_ERROR_SIZE where the number of elements is another one. */
HM_API hm_result hm_hair_read_positions(hm_hair hair, const hm_target* target);

/** Copies the vertices' velocities (m/s), as hm_hair_read_positions. @param hair a hair. @param target room for three
 * numbers a vertex. @return HM_ERROR_SIZE where the number of elements is another one. */
HM_API hm_result hm_hair_read_velocities(hm_hair hair, const hm_target* target);

/* ---- strands ---------------------------------------------------------------------------------------------------- */

/** Which strands are grown, and how finely. The parameter "strands" says how many there are. */
typedef struct hm_strand_settings {
  const int32_t* numbers; /**< Of the strands; NULL: `first` and the `count` - 1 after it. */
  int32_t first;          /**< First strand where no numbers are given. */
  int32_t count;          /**< Strands. */
  int32_t points;         /**< A strand, at least 2, evenly from root to tip. */
} hm_strand_settings;

/** Where strands go to: `points` elements a strand, strand after strand. */
typedef struct hm_strand_output {
  hm_target positions; /**< Three numbers each: m, world. */
  hm_target tangents;  /**< Three numbers each: unit vectors. */
  hm_target radii;     /**< One number each: m; 0 for a strand that is not drawn, as where a hairline thins out. */
} hm_strand_output;

/** What a strand is, whatever the pose. */
typedef struct hm_strand {
  int32_t face;    /**< Root face that it grows on. */
  double place[2]; /**< In the unit square of the face, whose corners are (0,0), (1,0), (1,1), (0,1); folded along its
                        diagonal for a triangle. */
  double end;      /**< Layers that it reaches. */
  int32_t flyaway; /**< 1: it leaves its clump. */
} hm_strand;

/** Fills the settings with all of no strands, of 16 points each. @param settings to fill. */
HM_API void hm_default_strand_settings(hm_strand_settings* settings);

/**
 * Grows strands from the present state, as the shaders draw them: points agree within 1e-5 of the hair's length, but for
 * a strand in 75,000 (8e-5).
 * @param hair     a hair.
 * @param settings which strands.
 * @param output   arrays to fill; those without data are left out.
 * @return HM_ERROR_SIZE where an array has not count * points elements, or what else was wrong.
 */
HM_API hm_result hm_hair_grow_strands(hm_hair hair, const hm_strand_settings* settings,
                                      const hm_strand_output* output);

/** Tells what a strand is. @param hair a hair. @param number of the strand. @param strand to fill. @return HM_OK or what
 * was wrong. */
HM_API hm_result hm_hair_describe_strand(hm_hair hair, int32_t number, hm_strand* strand);

#ifdef __cplusplus
}
#endif

#endif
