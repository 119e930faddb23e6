/* The boundary between Mullion and a plug-in library: plain C structs, nothing else crosses.
 *
 * A plug-in exports one data symbol, `mullion_plugin`, a constant-initialised mullion_header. The loader reads
 * magic, abi, bytes, kind, name, version (and build, for drivers) before it calls anything. C++ authors include
 * plugin.hpp, which fills all of this in; this header is what a C, Fortran or Python binding would use.
 *
 * Who owns what: strings and tables belong to the plug-in and live as long as the library is loaded; arrays
 * returned by the services belong to Mullion and are valid during one call only. */
#ifndef MULLION_SDK_ABI_H
#define MULLION_SDK_ABI_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define MULLION_ABI 2u
#define MULLION_MAGIC UINT64_C(0x314e4f494c4c554d) /* "MULLION1" read as a little-endian number */
#define MULLION_PLUGIN_SYMBOL "mullion_plugin"

/* limits, each with a clear error where it is reached */
#define MULLION_MAX_ARGUMENTS 8
#define MULLION_MAX_LEVELS 8
#define MULLION_MAX_NAME 64 /* bytes of a name, its terminating zero included */
#define MULLION_UNCONNECTED UINT32_C(0xffffffff)

enum mullion_location { MULLION_NODE = 0, MULLION_ELEMENT = 1, MULLION_PANE = 2 };
enum mullion_role { MULLION_STATE = 0, MULLION_OUTPUT = 1, MULLION_FIXED = 2 };
enum mullion_nature { MULLION_INTENSIVE = 0, MULLION_EXTENSIVE = 1 };
enum mullion_carry { MULLION_COPY = 0, MULLION_OVERWRITE = 1 };
enum mullion_scalar { MULLION_F64 = 0, MULLION_I32 = 1 };
enum mullion_type { MULLION_REAL = 0, MULLION_INTEGER = 1, MULLION_BOOLEAN = 2, MULLION_TEXT = 3 };
enum mullion_time_policy { MULLION_CONSTANT = 0, MULLION_LINEAR = 1, MULLION_QUADRATIC = 2 };
enum mullion_stamp_kind { MULLION_INSTANT = 0, MULLION_MEAN = 1 };
enum mullion_status { MULLION_OK = 0 }; /* any other value is an Errc of error.hpp */
enum mullion_log_level { MULLION_DEBUG = 1, MULLION_INFO = 2, MULLION_WARNING = 3, MULLION_ERROR = 4 };

enum mullion_element {
  MULLION_POINT1 = 0,
  MULLION_LINE2 = 1,
  MULLION_TRIANGLE3 = 2,
  MULLION_QUADRILATERAL4 = 3,
  MULLION_TETRAHEDRON4 = 4,
  MULLION_PYRAMID5 = 5,
  MULLION_PRISM6 = 6,
  MULLION_HEXAHEDRON8 = 7
};

/* ---- what a plug-in declares ---------------------------------------------------------------------------- */

typedef struct mullion_parameter_spec {
  const char* name;
  const char* unit;
  const char* meaning;
  const char* const* choices; /* texts only: the legal values, or NULL */
  uint32_t n_choices;
  uint32_t type;          /* mullion_type */
  uint32_t is_required;   /* 1: there is no default */
  uint32_t excludes;      /* bit 0: lower is not legal itself; bit 1: upper is not legal itself */
  uint32_t is_changeable; /* 1: `mullion set` may change it in a live run, whose state lives in windows */
  uint32_t reserved;
  double lower, upper;  /* range of a number; -inf, +inf where there is none */
  double default_real;
  int64_t default_integer; /* integers and booleans */
  const char* default_text;
} mullion_parameter_spec;

/* A field that the module owns. `components` 0 stands for the spatial dimension of the window. */
typedef struct mullion_field_spec {
  const char* window;
  const char* name;
  const char* unit;
  const char* meaning;
  uint32_t location, components, role, nature, carry, scalar;
} mullion_field_spec;

/* A field that the module receives, in the companion of its window `window`. */
typedef struct mullion_input_spec {
  const char* window;
  const char* name;
  const char* unit;
  const char* meaning;
  uint32_t location, components, nature, is_required;
} mullion_input_spec;

/* A function found by name. `writes`: the window whose working level it writes, "" for none. */
typedef struct mullion_function_spec {
  const char* name;
  const char* meaning;
  const char* writes;
  uint32_t n_arguments, n_results;
} mullion_function_spec;

/* ---- what crosses during a run -------------------------------------------------------------------------- */

typedef struct mullion_value {
  double real;
  int64_t integer; /* integers and booleans */
  const char* text;
} mullion_value;

typedef struct mullion_step {
  int64_t index;     /* coupling step, 1 for the first; 0 in start */
  double begin, end; /* s; in start both are the initial time */
  double dt;         /* s: the size, the same bits in every step but a shortened one (end - begin is not) */
  int32_t iteration; /* of a step that is iterated, 0 for the first */
  int32_t reserved;
} mullion_step;

typedef struct mullion_block {
  uint32_t element; /* mullion_element */
  uint32_t nodes_per_element;
  int64_t n_elements;
  const int32_t* connectivity; /* nodes_per_element x n_elements, one element a column, 0-based in the pane */
} mullion_block;

typedef struct mullion_pane {
  int64_t id; /* unique over the whole (possibly partitioned) window */
  int64_t n_nodes;
  int64_t n_elements;
  const double* coordinates; /* dimension x n_nodes, reference configuration [m] */
  const mullion_block* blocks;
  uint32_t n_blocks;
  uint32_t dimension;
} mullion_pane;

typedef struct mullion_array {
  void* data; /* components x entities, one entity a column, 64-byte aligned */
  int64_t components, entities;
  uint32_t scalar;
  uint32_t is_writable;
} mullion_array;

typedef struct mullion_stamp {
  double time; /* s: the time FOR WHICH the values hold */
  int64_t step;
  int32_t iteration;
  int32_t kind; /* mullion_stamp_kind; a mean holds over the coupling step that ends at the step's end */
} mullion_stamp;

typedef struct mullion_received {
  uint32_t policy; /* mullion_time_policy, the driver's choice */
  uint32_t n_levels;
  mullion_stamp stamps[MULLION_MAX_LEVELS]; /* newest first */
  const double* data[MULLION_MAX_LEVELS];
  int64_t components, entities;
} mullion_received;

/* What Mullion offers to a module. Every function returns a mullion_status; after a failure error_text() says
 * what happened. `context` is the first argument of create(). */
typedef struct mullion_services {
  uint32_t abi, bytes;
  /* define only: make a window of the declared fields over these panes */
  int32_t (*make_window)(void* context, const char* window, const mullion_pane* panes, uint32_t n_panes);
  /* define only: the mesh and the fixed fields of another module's window; "" is that kind's interface window */
  int32_t (*peer_pane)(void* context, const char* kind, const char* window, uint32_t pane, mullion_pane* out);
  int32_t (*peer_fixed)(void* context, const char* kind, const char* window, uint32_t pane, const char* field,
                        mullion_array* out);
  /* attach and after: handles stay valid until the next attach, the arrays during one call */
  int32_t (*pane)(void* context, const char* window, uint32_t pane, mullion_pane* out);
  int32_t (*field)(void* context, const char* window, uint32_t pane, const char* name, uint32_t* handle);
  int32_t (*view)(void* context, uint32_t handle, int32_t level, mullion_array* out);
  int32_t (*input)(void* context, const char* window, uint32_t pane, const char* name, uint32_t* handle);
  int32_t (*received)(void* context, uint32_t handle, mullion_received* out);
  /* any time */
  const char* (*error_text)(void* context);
  void (*fail)(void* context, int32_t status, const char* text);
  void (*log)(void* context, uint32_t level, const char* text);
} mullion_services;

/* A module. Every entry returns a mullion_status and reports its text with services->fail; none may throw. */
typedef struct mullion_module {
  const mullion_parameter_spec* parameters;
  const mullion_field_spec* fields;
  const mullion_input_spec* inputs;
  const mullion_function_spec* functions;
  uint32_t n_parameters, n_fields, n_inputs, n_functions;
  int32_t (*create)(void* context, const mullion_services*, const mullion_value* values, void** instance);
  void (*destroy)(void* instance);
  int32_t (*define)(void* instance, const mullion_step* initial);  /* fresh start: windows and first state */
  int32_t (*attach)(void* instance);                               /* every start: handles, derived data */
  int32_t (*start)(void* instance, const mullion_step* initial);   /* fresh start: what needs received fields */
  int32_t (*step)(void* instance, const mullion_step* step);
  int32_t (*call)(void* instance, uint32_t function, const mullion_step* step, const double* arguments,
                  double* results);
} mullion_module;

/* The one exported symbol. Constant-initialised: reading it runs no code of the plug-in. */
typedef struct mullion_header {
  uint64_t magic;
  uint32_t abi;
  uint32_t bytes; /* sizeof(mullion_header) */
  const char* kind;
  const char* name;
  const char* version;
  const char* summary;
  const char* build; /* drivers: build id of the libmullion they were compiled against; modules: NULL */
  const void* (*entry)(void); /* modules: const mullion_module*; drivers: see coupling/driver_plugin.hpp */
} mullion_header;

#ifdef __cplusplus
}
#endif
#endif
