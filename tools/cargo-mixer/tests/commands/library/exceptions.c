/* Mixes with traps on: a floating-point exception ends the program with the setpoint that raised it. `airframes.h` is
 * written by the test: the airframes' headers, and AIRFRAMES(X), which lists them. Rotors are out in half of the mixes. */
#define _GNU_SOURCE
#include <fenv.h>
#include <float.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "airframes.h"

/* What is mixed now. */
static const char *airframe;
static mixer_wrench_t setpoint;
static float voltage_v;
static uint64_t failed;

static void trapped(int number, siginfo_t *info, void *context)
{
    const char *what = info->si_code == FPE_FLTDIV   ? "division by zero"
                       : info->si_code == FPE_FLTOVF ? "overflow"
                       : info->si_code == FPE_FLTINV ? "invalid operation"
                                                     : "another exception";
    (void)number;
    (void)context;
    fedisableexcept(FE_ALL_EXCEPT);
    printf("%s: %s at %.9g,%.9g,%.9g,%.9g, %.9g V, rotors out %llx\n", airframe, what, setpoint.roll_nm,
           setpoint.pitch_nm, setpoint.yaw_nm, setpoint.thrust_n, voltage_v, (unsigned long long)failed);
    fflush(stdout);
    _exit(1);
}

/* xorshift32 */
static uint32_t state = 1;

static uint32_t below(uint32_t end)
{
    state ^= state << 13;
    state ^= state >> 17;
    state ^= state << 5;
    return (uint32_t)(((uint64_t)state * end) >> 32);
}

static float uniform(float low, float high)
{
    return low + (high - low) * (float)below(1u << 24) / (float)(1u << 24);
}

/* A component: within what the vehicle gives, on a grid of it, or any finite number. */
static float component(uint32_t kind, float unit)
{
    static const float special[] = {0.0f, 0x1p-149f, 1e-40f, FLT_MIN, 1e-20f, 1.0f, 99999.0f, 1e5f, 1.00001e5f,
                                    1e20f, 3e38f, FLT_MAX};
    float value = 0.0f;
    switch (kind) {
    case 0:
        return uniform(-1.3f, 1.3f) * unit;
    case 1:
        return 0.25f * (float)((int)below(11) - 5) * unit;
    case 2:
        value = special[below(sizeof special / sizeof special[0])];
        break;
    default: {
        /* Any bits of a finite number. */
        union {
            uint32_t bits;
            float value;
        } any;
        any.bits = below(0x7f800000u);
        value = any.value;
    }
    }
    return below(2) ? value : -value;
}

static float voltage(float reference)
{
    switch (below(8)) {
    case 0:
        return 0.0f;
    case 1:
        return component(2, 1.0f);
    case 2:
        return component(3, 1.0f);
    case 3:
    case 4:
        return reference;
    default:
        return uniform(0.6f, 1.3f) * reference;
    }
}

/* Half of the setpoints have all rotors, a quarter one out, the rest up to two or any. */
static uint64_t rotors_out(unsigned channels)
{
    uint64_t any = ((uint64_t)below(0xffffffffu) << 32) ^ below(0xffffffffu);
    switch (below(4)) {
    case 0:
        return (uint64_t)1 << below(channels);
    case 1:
        return below(2) ? any : ((uint64_t)1 << below(channels)) | ((uint64_t)1 << below(channels));
    default:
        return 0;
    }
}

#define MIX(module) \
    (failed ? module##_mix_with_health(&setpoint, voltage_v, failed, &out) : module##_mix(&setpoint, voltage_v, &out))

/* Half of the setpoints are near what the vehicle gives, the rest of mixed kinds. */
#define ALL(module, prefix)                                                            \
    static void module##_all(unsigned long setpoints)                                  \
    {                                                                                  \
        airframe = #module;                                                            \
        for (; setpoints > 0; --setpoints) {                                           \
            module##_mix_t out;                                                        \
            int is_near = below(2) != 0, status;                                       \
            setpoint.roll_nm = component(is_near ? 0 : below(4), prefix##_ROLL_NM);    \
            setpoint.pitch_nm = component(is_near ? 0 : below(4), prefix##_PITCH_NM);  \
            setpoint.yaw_nm = component(is_near ? 0 : below(4), prefix##_YAW_NM);      \
            setpoint.thrust_n = component(is_near ? 0 : below(4), prefix##_THRUST_N);  \
            voltage_v = voltage(prefix##_REFERENCE_V);                                 \
            failed = rotors_out(prefix##_CHANNELS);                                    \
            feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);                   \
            status = MIX(module);                                                      \
            fedisableexcept(FE_ALL_EXCEPT);                                            \
            if (status != MIXER_OK) {                                                  \
                printf("%s: status %d\n", airframe, status);                           \
                exit(1);                                                               \
            }                                                                          \
        }                                                                              \
        printf("%s: no exception\n", airframe);                                        \
    }

AIRFRAMES(ALL)

#define RUN(module, prefix) module##_all(setpoints);

/* The argument is the number of setpoints per airframe. */
int main(int count, char **words)
{
    unsigned long setpoints = count == 2 ? strtoul(words[1], NULL, 10) : 0;
    struct sigaction action = {0};
    action.sa_sigaction = trapped;
    action.sa_flags = SA_SIGINFO;
    sigaction(SIGFPE, &action, NULL);
    AIRFRAMES(RUN)
    return setpoints == 0;
}
