/* For rotors that are under way from speed to speed: what they are worth, by channel, the throttle that would hold the speed.
 * All zero is at rest: what begins after a disarm, a stop or a pause. */
@LAG@typedef struct {
    float worth[@PREFIX@_CHANNELS];
} @M@_state_t;

/* The same with a state that moves on by `held_s`, s, for which the throttles will be held; below 0, and NaN, are 0. `achieved`
 * and `saturation` are those of steady speeds. `*state` is as it was where the status is not 0. An object of its own in
 * lib@M@.a. */
int @M@_mix_dynamic(@M@_state_t *state, const mixer_wrench_t *setpoint, const mixer_conditions_t *conditions,
    float held_s, @M@_mix_t *out);

/* Moves on a state from before the mix, for who gave other throttles than it did. */
void @M@_follow(@M@_state_t *state, const float given[@PREFIX@_CHANNELS], float held_s);

/* With rotors out, in a library of --health: an object of its own. */
int @M@_mix_dynamic_with_health(@M@_state_t *state, const mixer_wrench_t *setpoint,
    const mixer_conditions_t *conditions, uint64_t failed, float held_s, @M@_mix_t *out);

