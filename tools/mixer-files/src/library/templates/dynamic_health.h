/* With rotors out. An object of its own. */
int @M@_mix_dynamic_with_health(@M@_state_t *state, const mixer_wrench_t *setpoint,
    const mixer_conditions_t *conditions, uint64_t failed, float held_s, @M@_mix_t *out);

