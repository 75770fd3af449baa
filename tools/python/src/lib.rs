//! What Python calls: the functions of the command line, on arrays of numpy. `coaxial_mixer` is the
//! face.

use pyo3::prelude::*;

pyo3::create_exception!(
    coaxial_mixer,
    MixerError,
    pyo3::exceptions::PyValueError,
    "What is wrong with an input, with its place and the mend."
);

fn error(message: impl std::fmt::Display) -> PyErr {
    MixerError::new_err(message.to_string())
}

#[pymodule]
mod _native {
    use std::fmt::Display;
    use std::sync::{Mutex, PoisonError};

    use cargo_mixer::bench_args::parsed;
    use cargo_mixer::bench_files;
    use cargo_mixer::commands::identify::{IdentifyArgs, NoAnswer};
    use cargo_mixer::commands::predict::PredictArgs;
    use cargo_mixer::commands::{mix, wrench};
    use cargo_mixer::frame_args::FrameArgs;
    use cargo_mixer::place::tables_or_airframe;
    use cargo_mixer::rows::{self, Row};
    use isolated_rotors::IsolatedTables;
    use mixer_compiler::tables::AnyMix;
    use mixer_compiler::{Compiled, Source};
    use mixer_facts::Checked;
    use mixer_identify::refusal::Refusal;
    use mixer_identify::texts::Outcome;
    use mixer_rt::Health;
    use numpy::ndarray::{Array1, ArrayView1, IntoDimension, Ix2, Ix3};
    use numpy::{Element, PyArray, PyArray1, PyArrayMethods as _, PyReadonlyArray1, PyReadonlyArray2};
    use pyo3::prelude::*;
    use pyo3::types::PyTuple;

    #[pymodule_export]
    use super::MixerError;
    use super::error;

    /// A number per row.
    type Column<'py, T> = Option<PyReadonlyArray1<'py, T>>;

    /// Rows with their voltages and densities, and the channels that are out.
    type Rows<'py, T> = (
        PyReadonlyArray2<'py, T>,
        Column<'py, T>,
        Column<'py, T>,
        Vec<usize>,
    );

    /// An array that is handed over.
    type Made<'py, T, D> = PyResult<Bound<'py, PyArray<T, D>>>;

    /// An array of a shape.
    fn array<'py, T: Element, S: IntoDimension>(
        py: Python<'py>,
        values: impl IntoIterator<Item = T>,
        shape: S,
    ) -> Made<'py, T, S::Dim> {
        PyArray1::from_vec(py, values.into_iter().collect()).reshape(shape)
    }

    /// An airframe file that compiles.
    #[pyclass(frozen)]
    struct Native {
        checked: Checked,
    }

    impl Native {
        fn rotors(&self) -> usize {
            self.checked.compiled.airframe.rotors()
        }

        /// Answers every row, or names the first that is bad. The rows are copied, so that other threads of Python may
        /// go on meanwhile.
        fn answers<T: Element + Copy, A: Send, E: Display>(
            &self,
            py: Python<'_>,
            (table, volts, density, failed): Rows<'_, T>,
            answer: impl Fn(&Compiled, Health, &Row<T>) -> Result<A, E> + Sync,
        ) -> PyResult<Vec<A>> {
            let compiled = &self.checked.compiled;
            let health = rows::health(&compiled.airframe, failed).map_err(error)?;
            let table = table.to_owned_array();
            let [volts, density] =
                [volts, density].map(|column| column.map(|column| column.to_owned_array()));
            let at = |column: &Option<Array1<T>>, k: usize| column.as_ref()?.get(k).copied();
            let answer = |(k, values): (usize, ArrayView1<'_, T>)| {
                let row = Row {
                    values: values.to_vec(),
                    voltage_v: at(&volts, k),
                    density_kg_m3: at(&density, k),
                };
                answer(compiled, health, &row).map_err(|message| format!("row {k}: {message}"))
            };
            py.detach(|| {
                table
                    .outer_iter()
                    .enumerate()
                    .map(answer)
                    .collect::<Result<_, _>>()
            })
            .map_err(error)
        }
    }

    impl Native {
        fn mixed<'py>(&self, py: Python<'py>, mixed: Vec<AnyMix>) -> PyResult<Bound<'py, PyTuple>> {
            let n = mixed.len();
            let throttles = array(py, mixed.iter().flat_map(|mix| mix.0.clone()), [n, self.rotors()])?;
            let achieved = array(py, mixed.iter().flat_map(|mix| mix.1.to_array()), [n, 4])?;
            let saturation = array(py, mixed.iter().map(|mix| mix.2.bits()), [n])?;
            (throttles, achieved, saturation).into_pyobject(py)
        }
    }

    #[pymethods]
    impl Native {
        #[new]
        fn new(py: Python<'_>, name: &str, text: Vec<u8>) -> PyResult<Self> {
            let check = || Source::from_bytes(name, text).and_then(|source| mixer_facts::check(&source));
            let checked = py.detach(check);
            Ok(Native {
                checked: checked.map_err(error)?,
            })
        }

        #[getter]
        fn name(&self) -> &str {
            &self.checked.compiled.airframe.name
        }

        /// Channels of the upper and of the lower rotor per unit, of a single rotor its one.
        #[getter]
        fn channels<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyTuple>>> {
            let units = self.checked.compiled.airframe.units.iter();
            let channels = units.map(|unit| unit.channels().collect::<Vec<_>>());
            channels.map(|channels| PyTuple::new(py, channels)).collect()
        }

        #[getter]
        fn verdict(&self) -> String {
            self.checked.verdict()
        }

        #[getter]
        fn warnings(&self) -> Vec<String> {
            self.checked.warnings.lines()
        }

        #[getter]
        fn rust(&self) -> String {
            self.checked.compiled.rust()
        }

        #[getter]
        fn json(&self) -> String {
            self.checked.json(()).to_string()
        }

        /// Throttles, achieved wrenches, saturation.
        fn mix<'py>(&self, py: Python<'py>, rows: Rows<'py, f32>) -> PyResult<Bound<'py, PyTuple>> {
            let mixed = self.answers(py, rows, mix::mix)?;
            self.mixed(py, mixed)
        }

        /// The same of the rows of one flight, their times in the fifth column.
        fn mix_dynamic<'py>(&self, py: Python<'py>, rows: Rows<'py, f32>) -> PyResult<Bound<'py, PyTuple>> {
            let memory = Mutex::default();
            let mixed = self.answers(py, rows, |compiled, health, row| {
                let memory = &mut *memory.lock().unwrap_or_else(PoisonError::into_inner);
                mix::mix_dynamic(compiled, health, row, memory)
            })?;
            self.mixed(py, mixed)
        }

        /// Throttles of the conventional mixer, and whether none was clipped.
        fn conventional<'py>(&self, py: Python<'py>, rows: Rows<'py, f32>) -> PyResult<Bound<'py, PyTuple>> {
            let isolated = IsolatedTables::new(&self.checked.compiled);
            let mixed = self.answers(py, rows, |compiled, _, row| {
                let reference_v = compiled.airframe.reference_v() as f32;
                isolated.conventional(&mix::setpoint(row), row.voltage_v.unwrap_or(reference_v))
            })?;
            let n = mixed.len();
            let throttles = array(py, mixed.iter().flat_map(|mix| mix.0.clone()), [n, self.rotors()])?;
            let within = array(py, mixed.iter().map(|mix| mix.1), [n])?;
            (throttles, within).into_pyobject(py)
        }

        fn wrench<'py>(&self, py: Python<'py>, rows: Rows<'py, f64>) -> Made<'py, f64, Ix2> {
            let wrenches = self.answers(py, rows, wrench::wrench)?;
            let n = wrenches.len();
            array(py, wrenches.into_iter().flatten(), [n, 4])
        }

        /// Thrust and torque of every unit.
        fn efforts<'py>(&self, py: Python<'py>, rows: Rows<'py, f64>) -> Made<'py, f64, Ix3> {
            let efforts = self.answers(py, rows, wrench::efforts)?;
            let n = efforts.len();
            array(
                py,
                efforts.into_iter().flatten().flatten(),
                [n, self.checked.compiled.airframe.units.len(), 2],
            )
        }
    }

    /// Tables, report, details, JSON, notes.
    type Texts = PyResult<(String, String, String, String, Vec<String>)>;

    fn refused(refusals: Vec<Refusal>) -> PyErr {
        let told: Vec<String> = refusals.iter().map(Refusal::to_string).collect();
        error(told.join("\n"))
    }

    fn texts<T>(answer: Outcome<T>, frame: Option<&FrameArgs>, notes: Vec<String>) -> Texts {
        let tables = tables_or_airframe(&answer, frame, None).map_err(error)?;
        Ok((tables, answer.report, answer.details, answer.json, notes))
    }

    #[pyfunction]
    fn identify(py: Python<'_>, words: Vec<String>) -> Texts {
        let args: IdentifyArgs = parsed("identify", words.iter().map(String::as_str)).map_err(error)?;
        let answer = py.detach(|| args.answer(&bench_files::text));
        let (answer, notes) = answer.map_err(|none| match none {
            NoAnswer::Usage(message) => error(message),
            NoAnswer::Refused(refusals) => refused(refusals),
        })?;
        texts(answer, args.place.frame.as_ref(), notes)
    }

    #[pyfunction]
    fn predict(py: Python<'_>, words: Vec<String>) -> Texts {
        let args: PredictArgs = parsed("predict", words.iter().map(String::as_str)).map_err(error)?;
        let answer = py.detach(|| args.answer(&bench_files::text)).map_err(refused)?;
        texts(answer, args.place.frame.as_ref(), Vec::new())
    }
}
