/* A gear mesh as a functional mock-up unit (FMI 3.0, model exchange and co-simulation), without a state of its own.
 *
 * Tooth pairs are springs that only push. With the approach d = r1 * driver_angle - r2 * driven_angle of the gears along
 * the line of action and the phase s = z1 * driver_angle / (2 pi) + phase in base pitches, spring j carries
 * k_j(s) * (d - e_j(s)) where that is positive. Once the backlash is used up, all of them push on the back flanks:
 * K(s) * (d + backlash) where that is negative. Damping acts on the rate of approach while any teeth touch.
 * k_j and e_j are polynomials between break points, made for one mean load each; between loads forces are interpolated.
 * mesh_tables.h is written by fegear. */
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "mesh_tables.h"

#if defined _WIN32
#define API __declspec(dllexport)
#else
#define API __attribute__((visibility("default")))
#endif

typedef enum { OK, WARNING, DISCARD, ERROR, FATAL } Status;
typedef uint32_t Reference;
typedef void (*Log)(void *environment, Status status, const char *category, const char *message);

enum {
    TIME, DRIVER_ANGLE, DRIVEN_ANGLE, DRIVER_SPEED, DRIVEN_SPEED, LOAD, BACKLASH, DAMPING, PHASE, LAST_SET = PHASE,
    MESH_FORCE, DRIVER_TORQUE, DRIVEN_TORQUE, APPROACH, MESH_STIFFNESS, STATIC_ERROR, INDICATOR,
    VARIABLES = INDICATOR + INDICATORS
};

typedef struct { double value[VARIABLES]; } State;
typedef struct { State now; void *environment; Log log; } Mesh;

static const double TWO_PI = 6.28318530717958647692;

static void defaults(State *state) {
    memset(state, 0, sizeof *state);
    state->value[LOAD] = NOMINAL_LOAD;
    state->value[BACKLASH] = START_BACKLASH;
    state->value[DAMPING] = START_DAMPING;
    state->value[PHASE] = START_PHASE;
}

/* Stiffness and separation of a spring at a phase [base pitches]. */
static void spring(int s, double phase, double *k, double *e) {
    const double u = phase / period[s] - floor(phase / period[s]);
    int low = first_piece[s], high = first_piece[s + 1] - 1;
    while (low < high) {
        const int middle = (low + high + 1) / 2;
        if (start_of[middle] <= u) low = middle; else high = middle - 1;
    }
    const double a = start_of[low], b = low + 1 < first_piece[s + 1] ? start_of[low + 1] : 1.0;
    const double v = ((u - a) - (b - u)) / (b - a);
    *k = *e = 0.0;
    for (int power = DEGREE; power >= 0; power--) {
        *k = *k * v + stiffness[low][power];
        *e = *e * v + separation[low][power];
    }
}

/* Force of the springs of one mean load on either flank; adds to its slope, sets the stiffness that touches. */
static double pushed(int load, double phase, double d, double backlash, double *slope, double *touching) {
    double force = 0.0, total = 0.0;
    *slope = *touching = 0.0;
    for (int s = first_spring[load]; s < first_spring[load + 1]; s++) {
        double k, e;
        spring(s, phase, &k, &e);
        total += k;
        if (k > 0.0 && d > e) { force += k * (d - e); *slope += k; }
    }
    if (d < -backlash) { force += total * (d + backlash); *slope += total; }
    *touching = *slope;
    return force;
}

/* The two loads around a load, and the share of the second. */
static double between(double load, int *low, int *high) {
    int i = 0;
    if (LOADS == 1 || load <= load_of[0]) { *low = *high = 0; return 0.0; }
    if (load >= load_of[LOADS - 1]) { *low = *high = LOADS - 1; return 0.0; }
    while (load_of[i + 1] < load) i++;
    *low = i; *high = i + 1;
    return (load - load_of[i]) / (load_of[i + 1] - load_of[i]);
}

static double force_at(const State *state, double phase, double d, double *slope, double *touching) {
    int low, high;
    const double share = between(state->value[LOAD], &low, &high), backlash = state->value[BACKLASH];
    double force = pushed(low, phase, d, backlash, slope, touching);
    *touching /= mean_stiffness[low];
    if (share > 0.0) {
        double other_slope, other_touching;
        const double other = pushed(high, phase, d, backlash, &other_slope, &other_touching);
        force += share * (other - force);
        *slope += share * (other_slope - *slope);
        *touching += share * (other_touching / mean_stiffness[high] - *touching);
    }
    return force;
}

/* Approach under the mean load at rest: Newton's steps from above end after a few, since the force is convex. */
static double static_error(const State *state, double phase) {
    double d = -1e30, stiffest = 0.0, slope, touching;
    if (state->value[LOAD] <= 0.0) return 0.0;
    for (int s = 0; s < SPRINGS; s++) {
        double k, e;
        spring(s, phase, &k, &e);
        if (k > stiffest) stiffest = k;
        if (k > 0.0 && e > d) d = e;
    }
    if (stiffest <= 0.0) return 0.0;
    d += 2.0 * state->value[LOAD] / stiffest;
    for (int again = 0; again < 4 * SPRINGS + 8; again++) {
        const double step = (force_at(state, phase, d, &slope, &touching) - state->value[LOAD]) / slope;
        if (!(slope > 0.0) || !(fabs(step) > 1e-15 * fabs(d))) break;
        d -= step;
    }
    return d;
}

/* Changes its sign wherever a stiffness or a separation jumps. */
static double past_jumps(double phase) {
    const double turns = floor(phase / JUMP_PERIOD), u = phase - turns * JUMP_PERIOD;
    double nearest = JUMP_PERIOD;
    int passed = 0;
    for (int i = 0; i < JUMPS; i++) {
        double away = fabs(u - jump[i]);
        if (away > 0.5 * JUMP_PERIOD) away = JUMP_PERIOD - away;
        if (away < nearest) nearest = away;
        if (jump[i] <= u) passed++;
    }
    return fmod(passed + turns * JUMPS, 2.0) == 0.0 ? nearest : -nearest;
}

static void evaluate(Mesh *mesh) {
    double *v = mesh->now.value, slope, touching;
    const double d = R_DRIVER * v[DRIVER_ANGLE] - R_DRIVEN * v[DRIVEN_ANGLE];
    const double rate = R_DRIVER * v[DRIVER_SPEED] - R_DRIVEN * v[DRIVEN_SPEED];
    const double phase = TEETH * v[DRIVER_ANGLE] / TWO_PI + v[PHASE];
    double force = force_at(&mesh->now, phase, d, &slope, &touching);
    if (touching > 0.0) force += v[DAMPING] * rate * (FOLLOWS_STIFFNESS ? sqrt(touching) : 1.0);
    v[MESH_FORCE] = force;
    v[DRIVER_TORQUE] = -R_DRIVER * force;
    v[DRIVEN_TORQUE] = R_DRIVEN * force;
    v[APPROACH] = d;
    v[MESH_STIFFNESS] = slope;
    v[STATIC_ERROR] = static_error(&mesh->now, phase);
    v[INDICATOR] = past_jumps(phase);
    v[INDICATOR + 1] = d + v[BACKLASH];
    for (int s = 0; s < SPRINGS; s++) {
        double k, e;
        spring(s, phase, &k, &e);
        v[INDICATOR + 2 + s] = d - e;
    }
}

static Status refuse(void *instance, const char *message) {
    Mesh *mesh = instance;
    if (mesh && mesh->log) mesh->log(mesh->environment, ERROR, "logStatusError", message);
    return ERROR;
}

static void *instantiate(const char *token, void *environment, Log log) {
    Mesh *mesh;
    if (!token || strcmp(token, TOKEN)) {
        if (log) log(environment, ERROR, "logStatusError", "The instantiation token is that of another FMU.");
        return NULL;
    }
    mesh = calloc(1, sizeof *mesh);
    if (!mesh) return NULL;
    mesh->environment = environment;
    mesh->log = log;
    defaults(&mesh->now);
    return mesh;
}

API const char *fmi3GetVersion(void) { return "3.0"; }

API Status fmi3SetDebugLogging(void *instance, bool on, size_t n, const char *const categories[]) {
    (void)instance; (void)on; (void)n; (void)categories;
    return OK;
}

API void *fmi3InstantiateModelExchange(
    const char *name, const char *token, const char *resources, bool visible, bool logging, void *environment, Log log) {
    (void)name; (void)resources; (void)visible; (void)logging;
    return instantiate(token, environment, log);
}

API void *fmi3InstantiateCoSimulation(
    const char *name, const char *token, const char *resources, bool visible, bool logging, bool events, bool early,
    const Reference wanted[], size_t n, void *environment, Log log, void *update) {
    (void)name; (void)resources; (void)visible; (void)logging; (void)events; (void)early; (void)wanted; (void)n;
    (void)update;
    return instantiate(token, environment, log);
}

API void *fmi3InstantiateScheduledExecution(
    const char *name, const char *token, const char *resources, bool visible, bool logging, void *environment, Log log,
    void *clock, void *lock, void *unlock) {
    (void)name; (void)token; (void)resources; (void)visible; (void)logging; (void)clock; (void)lock; (void)unlock;
    if (log) log(environment, ERROR, "logStatusError", "This FMU offers model exchange and co-simulation alone.");
    return NULL;
}

API void fmi3FreeInstance(void *instance) { free(instance); }

API Status fmi3EnterInitializationMode(void *i, bool defined, double tolerance, double start, bool ends, double stop) {
    (void)defined; (void)tolerance; (void)ends; (void)stop;
    ((Mesh *)i)->now.value[TIME] = start;
    return OK;
}

#define NOTHING(name) API Status name(void *instance) { (void)instance; return OK; }
NOTHING(fmi3ExitInitializationMode)
NOTHING(fmi3EnterEventMode)
NOTHING(fmi3EnterContinuousTimeMode)
NOTHING(fmi3EnterStepMode)
NOTHING(fmi3EvaluateDiscreteStates)
NOTHING(fmi3Terminate)

API Status fmi3Reset(void *instance) { defaults(&((Mesh *)instance)->now); return OK; }

API Status fmi3GetFloat64(void *instance, const Reference of[], size_t n, double values[], size_t count) {
    Mesh *mesh = instance;
    if (n != count) return refuse(instance, "Every variable has one value.");
    evaluate(mesh);
    for (size_t i = 0; i < n; i++) {
        if (of[i] >= VARIABLES) return refuse(instance, "No variable has this value reference.");
        values[i] = mesh->now.value[of[i]];
    }
    return OK;
}

API Status fmi3SetFloat64(void *instance, const Reference of[], size_t n, const double values[], size_t count) {
    if (n != count) return refuse(instance, "Every variable has one value.");
    for (size_t i = 0; i < n; i++) {
        if (of[i] == TIME || of[i] > LAST_SET) return refuse(instance, "Inputs and parameters alone can be set.");
        if (!isfinite(values[i])) return refuse(instance, "An input or a parameter is not finite.");
    }
    for (size_t i = 0; i < n; i++) ((Mesh *)instance)->now.value[of[i]] = values[i];
    return OK;
}

/* All variables are real numbers of double precision. */
#define NO_SUCH(kind, type) \
    API Status fmi3Get##kind(void *instance, const Reference of[], size_t n, type values[], size_t count) { \
        (void)of; (void)values; (void)count; \
        return n ? refuse(instance, "All variables are of type Float64.") : OK; \
    } \
    API Status fmi3Set##kind(void *instance, const Reference of[], size_t n, const type values[], size_t count) { \
        (void)of; (void)values; (void)count; \
        return n ? refuse(instance, "All variables are of type Float64.") : OK; \
    }
NO_SUCH(Float32, float)
NO_SUCH(Int8, int8_t)
NO_SUCH(UInt8, uint8_t)
NO_SUCH(Int16, int16_t)
NO_SUCH(UInt16, uint16_t)
NO_SUCH(Int32, int32_t)
NO_SUCH(UInt32, uint32_t)
NO_SUCH(Int64, int64_t)
NO_SUCH(UInt64, uint64_t)
NO_SUCH(Boolean, bool)
typedef const char *Text;
NO_SUCH(String, Text)

#define WITHOUT(name, ...) \
    API Status name(void *instance, __VA_ARGS__) { return refuse(instance, #name " is not offered by this FMU."); }
#if defined __GNUC__
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif
WITHOUT(fmi3GetBinary, const Reference *o, size_t n, size_t *s, const uint8_t **v, size_t c)
WITHOUT(fmi3SetBinary, const Reference *o, size_t n, const size_t *s, const uint8_t *const *v, size_t c)
WITHOUT(fmi3GetClock, const Reference *o, size_t n, bool *v)
WITHOUT(fmi3SetClock, const Reference *o, size_t n, const bool *v)
WITHOUT(fmi3GetNumberOfVariableDependencies, Reference o, size_t *n)
WITHOUT(fmi3GetVariableDependencies, Reference o, size_t *a, Reference *b, size_t *c, int *k, size_t n)
WITHOUT(fmi3GetDirectionalDerivative, const Reference *o, size_t a, const Reference *b, size_t c, const double *d,
        size_t e, double *f, size_t g)
WITHOUT(fmi3GetAdjointDerivative, const Reference *o, size_t a, const Reference *b, size_t c, const double *d,
        size_t e, double *f, size_t g)
WITHOUT(fmi3GetIntervalDecimal, const Reference *o, size_t n, double *v, int *q)
WITHOUT(fmi3GetIntervalFraction, const Reference *o, size_t n, uint64_t *a, uint64_t *b, int *q)
WITHOUT(fmi3GetShiftDecimal, const Reference *o, size_t n, double *v)
WITHOUT(fmi3GetShiftFraction, const Reference *o, size_t n, uint64_t *a, uint64_t *b)
WITHOUT(fmi3SetIntervalDecimal, const Reference *o, size_t n, const double *v)
WITHOUT(fmi3SetIntervalFraction, const Reference *o, size_t n, const uint64_t *a, const uint64_t *b)
WITHOUT(fmi3SetShiftDecimal, const Reference *o, size_t n, const double *v)
WITHOUT(fmi3SetShiftFraction, const Reference *o, size_t n, const uint64_t *a, const uint64_t *b)
WITHOUT(fmi3GetOutputDerivatives, const Reference *o, size_t n, const int32_t *a, double *v, size_t c)
WITHOUT(fmi3ActivateModelPartition, Reference o, double t)

API Status fmi3EnterConfigurationMode(void *i) { return refuse(i, "This FMU has no structural parameters."); }
API Status fmi3ExitConfigurationMode(void *i) { return refuse(i, "This FMU has no structural parameters."); }

API Status fmi3GetFMUState(void *instance, void **kept) {
    if (!*kept && !(*kept = malloc(sizeof(State)))) return refuse(instance, "There is no memory for a state.");
    memcpy(*kept, &((Mesh *)instance)->now, sizeof(State));
    return OK;
}

API Status fmi3SetFMUState(void *instance, void *kept) {
    memcpy(&((Mesh *)instance)->now, kept, sizeof(State));
    return OK;
}

API Status fmi3FreeFMUState(void *instance, void **kept) {
    (void)instance;
    free(*kept);
    *kept = NULL;
    return OK;
}

API Status fmi3SerializedFMUStateSize(void *instance, void *kept, size_t *size) {
    (void)instance; (void)kept;
    *size = sizeof(State);
    return OK;
}

API Status fmi3SerializeFMUState(void *instance, void *kept, uint8_t bytes[], size_t size) {
    if (size != sizeof(State)) return refuse(instance, "The serialized state has another size.");
    memcpy(bytes, kept, size);
    return OK;
}

API Status fmi3DeserializeFMUState(void *instance, const uint8_t bytes[], size_t size, void **kept) {
    if (size != sizeof(State)) return refuse(instance, "The serialized state has another size.");
    if (!*kept && !(*kept = malloc(size))) return refuse(instance, "There is no memory for a state.");
    memcpy(*kept, bytes, size);
    return OK;
}

API Status fmi3UpdateDiscreteStates(
    void *instance, bool *again, bool *terminate, bool *nominals, bool *values, bool *defined, double *next) {
    (void)instance; (void)next;
    *again = *terminate = *nominals = *values = *defined = false;
    return OK;
}

API Status fmi3CompletedIntegratorStep(void *instance, bool final, bool *event, bool *terminate) {
    (void)instance; (void)final;
    *event = *terminate = false;
    return OK;
}

API Status fmi3SetTime(void *instance, double time) { ((Mesh *)instance)->now.value[TIME] = time; return OK; }

#define NO_STATES(name, type) \
    API Status name(void *instance, type values[], size_t n) { \
        (void)values; \
        return n ? refuse(instance, "This FMU has no continuous states.") : OK; \
    }
NO_STATES(fmi3SetContinuousStates, const double)
NO_STATES(fmi3GetContinuousStates, double)
NO_STATES(fmi3GetContinuousStateDerivatives, double)
NO_STATES(fmi3GetNominalsOfContinuousStates, double)

API Status fmi3GetNumberOfContinuousStates(void *instance, size_t *n) { (void)instance; *n = 0; return OK; }
API Status fmi3GetNumberOfEventIndicators(void *instance, size_t *n) { (void)instance; *n = INDICATORS; return OK; }

API Status fmi3GetEventIndicators(void *instance, double values[], size_t n) {
    Mesh *mesh = instance;
    if (n != INDICATORS) return refuse(instance, "The FMU has another number of event indicators.");
    evaluate(mesh);
    memcpy(values, mesh->now.value + INDICATOR, n * sizeof *values);
    return OK;
}

API Status fmi3DoStep(
    void *instance, double now, double step, bool final, bool *event, bool *terminate, bool *early, double *last) {
    (void)final;
    ((Mesh *)instance)->now.value[TIME] = *last = now + step;
    *event = *terminate = *early = false;
    return OK;
}
