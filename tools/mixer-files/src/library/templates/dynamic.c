    {
        @M@_state_t state;
        memset(&state, 0, sizeof state);
        for (i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
            float in[6];
            mixer_wrench_t setpoint;
            mixer_conditions_t conditions;
            @M@_mix_t out;
            memcpy(in, rows[i].in, sizeof in);
            setpoint.roll_nm = in[0];
            setpoint.pitch_nm = in[1];
            setpoint.yaw_nm = in[2];
            setpoint.thrust_n = in[3];
            conditions.voltage_v = in[4];
            conditions.density_kg_m3 = in[5];
            (void)@M@_mix_dynamic(&state, &setpoint, &conditions, 0.004f, &out);
        }
        different += memcmp(&state, worth, sizeof worth) != 0;
    }
