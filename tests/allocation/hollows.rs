//! Sets that bend inwards: of the ends of a hollow the better one is found, on both sides of where another becomes the better.

use mixer_tests::optimum::Oracle;

use crate::compile;
use crate::continuity::{all_rotors, place, stays, stays_from};
use crate::polygons::assert_is_optimal;

/// Two ends of nearly the same thrust, 5 mN apart: the better one is taken on either side.
#[test]
fn the_better_of_two_ends_is_taken_however_near_they_are() {
    let places = [
        place(
            [0.322_281_083, 0.000_921_156_823, 0.005_068_003_1],
            [0.114_420_621, 0.021_362_212_7],
            true,
        ),
        place(
            [-0.071_072_912_7, 0.684_815_632, 0.035_549_688_8],
            [0.145_688_152, -0.064_160_678_8],
            false,
        ),
        place(
            [-0.447_129_336, 0.228_946_704, -0.005_400_376_53],
            [0.098_378_018_8, 0.018_534_458_2],
            false,
        ),
        place(
            [-0.253_497_759, -0.190_387_724, -0.038_073_957],
            [-0.081_999_908_7, 0.089_072_549_7],
            false,
        ),
        place(
            [0.259_693_227, -0.323_793_981, 0.044_241_880_8],
            [0.049_016_881_6, 0.047_480_674_6],
            true,
        ),
    ];
    let frame = compile(&places, "roll-pitch", 0.0);
    let asked = [
        [-7.329_782_5, -6.673_715_6, -1.399_513_1, 81.529_785],
        [-7.330_515_4, -6.674_383, -1.399_653_1, 81.53794],
    ];
    stays_from(&frame, asked, 14.115_237);
}

/// The unit in a hollow belongs to one end of it, but where it only starts there its path leads back into the hollow.
#[test]
fn a_unit_is_kept_at_the_ends_of_its_hollow() {
    let six = [
        place(
            [-0.427_819_87, -0.475_779_917, 0.033_710_532_2],
            [0.108_574_095, -0.112_156_061],
            true,
        ),
        place(
            [0.011_508_884_5, -0.351_591_836, -0.013_426_778_8],
            [0.055_895_699_3, -0.117_152_252],
            false,
        ),
        place(
            [0.581_979_36, -0.109_028_281, -0.025_123_306_7],
            [0.138_196_941, -0.133_612_871],
            true,
        ),
        place(
            [0.319_570_297, 0.322_193_095, -0.043_238_207_2],
            [-0.091_521_735_3, 0.130_356_032],
            false,
        ),
        place(
            [-0.020_042_491_6, 0.303_668_765, 0.000_821_665_582],
            [0.084_912_968_9, -0.135_218_416],
            false,
        ),
        place(
            [-0.461_667_125, 0.058_524_500_3, -0.043_709_614_2],
            [0.141_354_175, -0.133_157_859],
            true,
        ),
    ];
    let frame = compile(&six, "roll-pitch-yaw", 0.050_839_438_447_737_355);
    stays(
        &frame,
        [-3.699_548_7, 12.160_891, 1.678_315_2, 40.764_973],
        14.223_189,
        1,
    );
    let eight = [
        place(
            [-0.535_486_275, -0.013_050_253_5, -0.003_230_175_06],
            [0.146_420_058, -0.001_222_130_27],
            true,
        ),
        place(
            [-0.212_131_508, -0.201_192_663, -0.042_296_830_8],
            [0.143_847_849, -0.095_891_104_4],
            false,
        ),
        place(
            [-0.097_841_493_7, -0.456_033_433, -0.031_732_673_8],
            [-0.101_765_865, -0.039_114_555_1],
            false,
        ),
        place(
            [0.420_087_151, -0.521_629_225, 0.003_691_283_18],
            [0.065_804_940_9, -0.137_784_722],
            true,
        ),
        place(
            [0.455_576_032, -0.042_843_686, 0.000_381_070_976],
            [-0.094_182_980_2, -0.096_246_090_5],
            false,
        ),
        place(
            [0.466_930_732, 0.405_767_315, -0.046_031_487_9],
            [0.085_330_647_9, -0.088_048_912_4],
            true,
        ),
        place(
            [0.131_995_492, 0.347_567_254, 0.038_765_375_1],
            [-0.035_594_975, 0.115_146_453],
            false,
        ),
        place(
            [-0.286_777_172, 0.260_247_546, -0.029_671_769_7],
            [0.017_050_162_2, 0.141_802_734],
            true,
        ),
    ];
    let frame = compile(&eight, "roll-pitch-yaw", 0.0);
    let asked = [
        [0.0, -2.352_420_3, 1.126_618_7, 194.24454],
        [0.0, -2.352_655_6, 1.126_731_4, 194.26396],
    ];
    stays_from(&frame, asked, 12.895_046);
}

/// The unit that ends at one end of its hollow belongs to the other, from which the border falls before it rises: for a few
/// ten-thousandths of roll and pitch a quarter of the thrust was missed.
#[test]
fn the_other_end_of_a_hollow_is_tried_from_its_end() {
    let four = [
        place(
            [-0.671_477_571, 0.227_954_642, 0.017_448_347],
            [-0.116_466_185, 0.008_262_063],
            true,
        ),
        place(
            [-0.344_040_99, -0.538_300_101, -0.021_609_81],
            [-0.086_409_99, 0.122_695_464],
            false,
        ),
        place(
            [0.389_190_901, -0.270_162_919, -0.039_520_476],
            [0.089_721_348, 0.058_907_859],
            true,
        ),
        place(
            [0.348_173_863, 0.284_630_237, 0.045_686_548],
            [0.102_883_957, -0.107_042_018],
            false,
        ),
    ];
    let frame = compile(&four, "roll-pitch", 0.0);
    let asked = [-76.422_33, 38.121_5, 17.874_983, 33.795_4];
    assert_is_optimal(&frame, &all_rotors(asked, 13.684_681), Oracle::of_exact_polygons);
}

/// Both ends are out of bounds by rounding, which counts only by as much as it is more at one than at the other.
#[test]
fn ends_as_far_out_of_bounds_are_told_apart() {
    let five = [
        place(
            [0.337_342_411, -1.221_925_91, 0.024_267_014_2],
            [0.145_471_87, 0.100_274_999],
            true,
        ),
        place(
            [0.907_998_459, -0.312_553_271, -0.023_375_281_2],
            [-0.102_177_052, -0.041_181_356_9],
            false,
        ),
        place(
            [0.196_694_635, 0.340_797_102, 0.002_205_876_77],
            [0.009_446_593_96, 0.145_467_236],
            true,
        ),
        place(
            [-0.094_380_787_7, 0.238_354_429, 0.048_366_633_4],
            [0.060_292_900_4, 0.039_350_655_3],
            true,
        ),
        place(
            [-0.608_115_8, -0.312_300_001, -0.035_007_603_5],
            [0.016_512_18, -0.038_245_841_9],
            false,
        ),
    ];
    let frame = compile(&five, "roll-pitch", 0.0);
    stays(
        &frame,
        [20.091_745, 13.541_574_5, 1.188_025_5, 66.501_77],
        12.8,
        0,
    );
}
