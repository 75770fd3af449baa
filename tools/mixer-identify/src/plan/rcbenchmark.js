// Throttle pairs of a coaxial pair of rotors, by cargo mixer plan @VERSION@.
// For the RCbenchmark application with a series 1780: escA is the upper rotor, escB the lower one.
// Check that both turn the right way and that the stand is clear before you run it. The log goes to cargo mixer identify.

var pairs = [                  // pulse widths, microseconds: upper, lower
@PAIRS@
];
var stop = @STOP@;               // pulse width of a rotor at rest
var ramp_s = 1;                // from one pair to the next
var settle_s = 2;              // before each measurement
var samples = 40;              // averaged per pair

var outputs = ["escA", "escB"];
var last = [stop, stop];
var at = 0;

rcb.files.newLogFile({prefix: "coaxial-map"});
rcb.sensors.tareLoadCells(arm);

function arm() {
    rcb.output.set(outputs, last);
    rcb.wait(next, 4);
}

function next() {
    if (at === pairs.length) {
        rcb.output.ramp(outputs, last, [stop, stop], 2 * ramp_s, rcb.endScript);
        return;
    }
    rcb.console.print("Pair " + (at + 1) + " of " + pairs.length + ": " + pairs[at]);
    rcb.output.ramp(outputs, last, pairs[at], ramp_s, settle);
    last = pairs[at];
    at += 1;
}

function settle() {
    rcb.wait(measure, settle_s);
}

function measure() {
    rcb.sensors.read(record, samples);
}

function record(result) {
    rcb.files.newLogEntry(result, next);
}
