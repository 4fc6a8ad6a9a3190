"""A small importer of FMUs, of model exchange and co-simulation, FMI 2 and 3: prototypes declared from the standard.

    python3 importer.py flapper.fmu

co-simulates half a second, with the voltage a tenth lower after the first half of it."""

import ctypes as c
import pathlib
import sys
import tempfile
import zipfile
from xml.etree import ElementTree

OK, WARNING, DISCARD, ERROR = range(4)
LOGGER2 = c.CFUNCTYPE(None, c.c_void_p, c.c_char_p, c.c_int, c.c_char_p, c.c_char_p, c.c_char_p)
LOGGER3 = c.CFUNCTYPE(None, c.c_void_p, c.c_int, c.c_char_p, c.c_char_p)


class Callbacks2(c.Structure):
    _fields_ = [
        ("logger", LOGGER2),
        ("allocate", c.c_void_p),
        ("free", c.c_void_p),
        ("step_finished", c.c_void_p),
        ("environment", c.c_void_p),
    ]


class EventInfo2(c.Structure):
    _fields_ = [
        ("again", c.c_int),
        ("terminate", c.c_int),
        ("nominals_changed", c.c_int),
        ("states_changed", c.c_int),
        ("next_defined", c.c_int),
        ("next", c.c_double),
    ]


class FmuError(Exception):
    def __init__(self, function, status, messages):
        super().__init__(f"{function}: status {status}: {'; '.join(messages)}")
        self.status = status


class Package:
    """An unpacked FMU: its description as a tree, variables by name, the library of its binary."""

    def __init__(self, file):
        self.folder = tempfile.TemporaryDirectory(prefix="wingbeat-fmu-")
        root = pathlib.Path(self.folder.name)
        with zipfile.ZipFile(file) as archive:
            self.names = archive.namelist()
            archive.extractall(root)
        self.root = root
        self.xml = ElementTree.parse(root / "modelDescription.xml").getroot()
        self.version = int(self.xml.get("fmiVersion")[0])
        self.token = self.xml.get("guid") or self.xml.get("instantiationToken")
        kinds = [self.xml.find(kind) for kind in ("ModelExchange", "CoSimulation")]
        self.identifier = next(kind for kind in kinds if kind is not None).get("modelIdentifier")
        self.variables = {v.get("name"): v for v in self.xml.find("ModelVariables")}
        self.functions = c.CDLL(str(self.binary()))

    def binary(self, windows=False):
        platforms = {2: ("linux64", "win64"), 3: ("x86_64-linux", "x86_64-windows")}
        ending = "dll" if windows else "so"
        return self.root / "binaries" / platforms[self.version][windows] / f"{self.identifier}.{ending}"

    def reference(self, name):
        return int(self.variables[name].get("valueReference"))


class Instance:
    """One instance; each method is a function of the standard, with the names of neither version."""

    def __init__(self, package, co_simulation, start=None, tolerance=None, values=None, binary=None):
        """Of the package's binary, or of another one for it."""
        self.package, self.co_simulation = package, co_simulation
        self.functions = c.CDLL(str(binary)) if binary else package.functions
        self.two = package.version == 2
        self.messages = []
        lib = self.functions
        resources = package.root / "resources"
        token = package.token.encode()
        if self.two:
            self._log = LOGGER2(lambda e, n, s, k, pattern, text: self.messages.append((text or b"").decode()))
            self._callbacks = Callbacks2(self._log, None, None, None, None)
            lib.fmi2Instantiate.restype = c.c_void_p
            made = lib.fmi2Instantiate(
                b"one", int(co_simulation), token, resources.as_uri().encode(), c.byref(self._callbacks), 0, 1
            )
        else:
            self._log = LOGGER3(lambda e, s, k, text: self.messages.append((text or b"").decode()))
            path = (str(resources) + "/").encode()
            if co_simulation:
                lib.fmi3InstantiateCoSimulation.restype = c.c_void_p
                lib.fmi3InstantiateCoSimulation.argtypes = [
                    *[c.c_char_p] * 3, *[c.c_bool] * 4, c.c_void_p, c.c_size_t, c.c_void_p, LOGGER3, c.c_void_p
                ]
                made = lib.fmi3InstantiateCoSimulation(
                    b"one", token, path, False, True, False, False, None, 0, None, self._log, None
                )
            else:
                lib.fmi3InstantiateModelExchange.restype = c.c_void_p
                lib.fmi3InstantiateModelExchange.argtypes = [
                    *[c.c_char_p] * 3, *[c.c_bool] * 2, c.c_void_p, LOGGER3
                ]
                made = lib.fmi3InstantiateModelExchange(b"one", token, path, False, True, None, self._log)
        if not made:
            raise FmuError("instantiate", ERROR, self.messages)
        self.handle = c.c_void_p(made)
        if start is not None:
            self.set(values or {})
            self.initialise(start, tolerance)

    def call(self, name, *arguments, name3=None):
        function = f"fmi2{name}" if self.two else f"fmi3{name3 or name}"
        status = getattr(self.functions, function)(self.handle, *arguments)
        if status > WARNING:
            raise FmuError(function, status, self.messages[-1:])

    def initialise(self, start=0.0, tolerance=None):
        t, given = c.c_double(tolerance or 0.0), tolerance is not None
        if self.two:
            self.call("SetupExperiment", int(given), t, c.c_double(start), 0, c.c_double(0.0))
            self.call("EnterInitializationMode")
        else:
            no, zero = c.c_bool(False), c.c_double(0.0)
            self.call("EnterInitializationMode", c.c_bool(given), t, c.c_double(start), no, zero)
        self.call("ExitInitializationMode")

    def _sized(self, count):
        """FMI 3 says the number of values once more."""
        return [] if self.two else [c.c_size_t(count)]

    def get(self, *names):
        n = len(names)
        references = (c.c_uint * n)(*map(self.package.reference, names))
        values = (c.c_double * n)()
        self.call("GetReal", references, c.c_size_t(n), values, *self._sized(n), name3="GetFloat64")
        return list(values)

    def whole(self, name):
        reference = c.c_uint(self.package.reference(name))
        if self.package.variables[name].tag == "Enumeration":  # of FMI 3, which gets them as other numbers
            value = c.c_int64()
            self.call("", c.byref(reference), c.c_size_t(1), c.byref(value), c.c_size_t(1), name3="GetInt64")
            return value.value
        value = c.c_int()
        self.call("GetInteger", c.byref(reference), c.c_size_t(1), c.byref(value), *self._sized(1), name3="GetInt32")
        return value.value

    def text(self, name):
        value = c.c_char_p()
        reference = c.c_uint(self.package.reference(name))
        self.call("GetString", c.byref(reference), c.c_size_t(1), c.byref(value), *self._sized(1))
        return value.value.decode()

    def set(self, values):
        n = len(values)
        references = (c.c_uint * n)(*map(self.package.reference, values))
        numbers = (c.c_double * n)(*values.values())
        self.call("SetReal", references, c.c_size_t(n), numbers, *self._sized(n), name3="SetFloat64")

    # ---- co-simulation
    def step(self, time, length):
        if self.two:
            self.call("DoStep", c.c_double(time), c.c_double(length), 1)
            return
        flags = [c.byref(c.c_bool()) for _ in range(3)]
        last = c.c_double()
        self.call("DoStep", c.c_double(time), c.c_double(length), c.c_bool(True), *flags, c.byref(last))

    # ---- states
    def save(self):
        state = c.c_void_p()
        self.call("GetFMUstate", c.byref(state), name3="GetFMUState")
        return state

    def restore(self, state):
        self.call("SetFMUstate", state, name3="SetFMUState")

    def free(self, state):
        self.call("FreeFMUstate", c.byref(state), name3="FreeFMUState")

    def serialise(self, state):
        size = c.c_size_t()
        self.call("SerializedFMUstateSize", state, c.byref(size), name3="SerializedFMUStateSize")
        bytes_ = (c.c_char * size.value)()
        self.call("SerializeFMUstate", state, bytes_, size, name3="SerializeFMUState")
        return bytes(bytes_)

    def deserialise(self, content, size=None):
        state = c.c_void_p()
        self.call(
            "DeSerializeFMUstate", content, c.c_size_t(len(content) if size is None else size), c.byref(state),
            name3="DeserializeFMUState",
        )  # fmt: skip
        return state

    def directional(self, unknowns, knowns, seed):
        u = (c.c_uint * len(unknowns))(*map(self.package.reference, unknowns))
        k = (c.c_uint * len(knowns))(*map(self.package.reference, knowns))
        out, given = (c.c_double * len(unknowns))(), (c.c_double * len(knowns))(*seed)
        self.call(
            "GetDirectionalDerivative", u, c.c_size_t(len(unknowns)), k, c.c_size_t(len(knowns)), given,
            *self._sized(len(knowns)), out, *self._sized(len(unknowns)),
        )  # fmt: skip
        return list(out)

    # ---- model exchange
    def _vector(self, function, count, name3=None):
        values = (c.c_double * count)()
        self.call(function, values, c.c_size_t(count), name3=name3)
        return list(values)

    @property
    def state_count(self):
        return sum(1 for name in self.package.variables if name.startswith("der("))

    @property
    def indicator_count(self):
        if self.two:
            return int(self.package.xml.get("numberOfEventIndicators"))
        count = c.c_size_t()
        self.call("", c.byref(count), name3="GetNumberOfEventIndicators")
        return count.value

    def states(self):
        return self._vector("GetContinuousStates", self.state_count)

    def nominals(self):
        return self._vector("GetNominalsOfContinuousStates", self.state_count)

    def rates(self):
        return self._vector("GetDerivatives", self.state_count, name3="GetContinuousStateDerivatives")

    def indicators(self):
        return self._vector("GetEventIndicators", self.indicator_count)

    def put(self, time, states):
        self.call("SetTime", c.c_double(time))
        self.call("SetContinuousStates", (c.c_double * len(states))(*states), c.c_size_t(len(states)))

    def update(self):
        """Terminate, states changed, time of the next event or None; then continuous time goes on."""
        if self.two:
            info = EventInfo2()
            self.call("NewDiscreteStates", c.byref(info))
            result = bool(info.terminate), bool(info.states_changed), info.next if info.next_defined else None
        else:
            flags, following = [c.c_bool() for _ in range(5)], c.c_double()
            self.call(
                "", *map(c.byref, flags), c.byref(following), name3="UpdateDiscreteStates"
            )
            result = flags[1].value, flags[3].value, following.value if flags[4].value else None
        self.call("EnterContinuousTimeMode")
        return result

    def event_mode(self):
        self.call("EnterEventMode")

    def terminate(self):
        self.call("Terminate")

    def reset(self):
        self.call("Reset")

    def close(self):
        if self.two:
            self.functions.fmi2FreeInstance(self.handle)
        else:
            self.functions.fmi3FreeInstance(self.handle)


def integrate(instance, until, tolerance=1e-9, sample=None):
    """Model exchange by DOP853 of SciPy, through events, to `until`; calls sample(time) after each step."""
    import numpy as np
    from scipy.integrate import DOP853
    from scipy.optimize import brentq

    time = instance.get("time")[0]
    terminate, _, following = instance.update()
    absolute = tolerance * np.array(instance.nominals())
    steps = 0
    while time < until and not terminate:
        stop = min(until, following) if following is not None else until

        def rates(t, y):
            instance.put(t, y)
            return np.array(instance.rates())

        def signs(t, y):
            instance.put(t, y)
            return np.array(instance.indicators())

        # SciPy's own first step probes far beyond `stop` where hardly anything moves.
        solver = DOP853(rates, time, np.array(instance.states()), stop, rtol=tolerance, atol=absolute,
                        first_step=1e-3 * (stop - time))  # fmt: skip
        event = False
        while solver.status == "running" and not event:
            solver.step()
            steps += 1
            dense, low, high = solver.dense_output(), solver.t_old, solver.t
            at_end = signs(high, solver.y)
            if (at_end <= 0.0).any():
                times = []
                for k in np.flatnonzero(at_end <= 0.0):
                    first = signs(low, dense(low))[k]
                    times.append(
                        brentq(lambda t: signs(t, dense(t))[k], low, high, xtol=1e-15, rtol=1e-14) if first > 0 else low
                    )
                high, event = min(times), True
            instance.put(high, dense(high) if event else solver.y)
            if sample:
                sample(high)
        time = high
        if event or (following is not None and time >= following):
            instance.event_mode()
            terminate, _, following = instance.update()
        elif time < until:
            raise RuntimeError("the integrator stopped")
    return steps


def main(file):
    package = Package(file)
    if package.xml.find("CoSimulation") is None:
        sys.exit(f"{file} is for model exchange alone")
    flapper = Instance(package, True, 0.0)
    names = ("frequency_mean", "lift_mean", "current_mean", "power_electrical_mean")
    print("time s  ", *(f"{name:>22}" for name in names))
    for k in range(500):
        if k == 250:
            flapper.set({"voltage": 0.9 * flapper.get("voltage")[0]})
        flapper.step(k * 1e-3, 1e-3)
        if k % 50 == 49:
            print(f"{(k + 1) * 1e-3:<8g}", *(f"{value:>22.6g}" for value in flapper.get(*names)))
    flapper.terminate()
    flapper.close()


if __name__ == "__main__":
    main(sys.argv[1])
