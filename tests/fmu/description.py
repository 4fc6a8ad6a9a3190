"""The rules of the standard that a model description of FMI 2.0 or 3.0 must keep, written down."""

from xml.etree import ElementTree

NAMES2 = ["UnitDefinitions", "TypeDefinitions", "LogCategories", "DefaultExperiment", "VendorAnnotations"]
ORDER = {
    2: ["ModelExchange", "CoSimulation", *NAMES2, "ModelVariables", "ModelStructure"],
    3: ["ModelExchange", "CoSimulation", "ScheduledExecution", "UnitDefinitions", "TypeDefinitions", "LogCategories",
        "DefaultExperiment", "ModelVariables", "ModelStructure", "Annotations"],
}  # fmt: skip
ATTRIBUTES = {
    2: {
        "ModelExchange": {"modelIdentifier", "needsExecutionTool", "completedIntegratorStepNotNeeded",
                          "canBeInstantiatedOnlyOncePerProcess", "canNotUseMemoryManagementFunctions",
                          "canGetAndSetFMUstate", "canSerializeFMUstate", "providesDirectionalDerivative"},
        "CoSimulation": {"modelIdentifier", "needsExecutionTool", "canHandleVariableCommunicationStepSize",
                         "canInterpolateInputs", "maxOutputDerivativeOrder", "canRunAsynchronuously",
                         "canBeInstantiatedOnlyOncePerProcess", "canNotUseMemoryManagementFunctions",
                         "canGetAndSetFMUstate", "canSerializeFMUstate", "providesDirectionalDerivative"},
    },
    3: {
        "ModelExchange": {"modelIdentifier", "needsExecutionTool", "canBeInstantiatedOnlyOncePerProcess",
                          "canGetAndSetFMUState", "canSerializeFMUState", "providesDirectionalDerivatives",
                          "providesAdjointDerivatives", "providesPerElementDependencies",
                          "needsCompletedIntegratorStep", "providesEvaluateDiscreteStates"},
        "CoSimulation": {"modelIdentifier", "needsExecutionTool", "canBeInstantiatedOnlyOncePerProcess",
                         "canGetAndSetFMUState", "canSerializeFMUState", "providesDirectionalDerivatives",
                         "providesAdjointDerivatives", "providesPerElementDependencies",
                         "canHandleVariableCommunicationStepSize", "fixedInternalStepSize",
                         "maxOutputDerivativeOrder", "recommendedIntermediateInputSmoothness",
                         "providesIntermediateUpdate", "mightReturnEarlyFromDoStep",
                         "canReturnEarlyAfterIntermediateUpdate", "hasEventMode", "providesEvaluateDiscreteStates"},
    },
}  # fmt: skip
# Allowed combinations of causality and variability, with the default of `initial` first (section 2.2.7 and 2.4.7.4).
INITIAL = {
    ("parameter", "fixed"): ["exact"], ("parameter", "tunable"): ["exact"],
    ("calculatedParameter", "fixed"): ["calculated", "approx"],
    ("calculatedParameter", "tunable"): ["calculated", "approx"],
    ("input", "discrete"): [None], ("input", "continuous"): [None],
    ("output", "constant"): ["exact"], ("output", "discrete"): ["calculated", "exact", "approx"],
    ("output", "continuous"): ["calculated", "exact", "approx"],
    ("local", "constant"): ["exact"], ("local", "fixed"): ["calculated", "approx"],
    ("local", "tunable"): ["calculated", "approx"], ("local", "discrete"): ["calculated", "exact", "approx"],
    ("local", "continuous"): ["calculated", "exact", "approx"],
    ("independent", "continuous"): [None],
}  # fmt: skip
LONGEST_NAME = 55


def typed(variable, version):
    return variable if version == 3 else variable[0]


def problems_of_build(package):
    """Of buildDescription.xml."""
    root = ElementTree.parse(package.root / "sources/buildDescription.xml").getroot()
    problems = []
    if root.tag != "fmiBuildDescription" or root.get("fmiVersion") != "3.0":
        problems.append("fmiBuildDescription of FMI 3.0")
    configurations = root.findall("BuildConfiguration")
    if [c.get("modelIdentifier") for c in configurations] != [package.identifier]:
        problems.append("one build configuration, of the model identifier")
    for configuration in configurations:
        if not set(configuration.keys()) <= {"modelIdentifier", "platform", "description"}:
            problems.append("attributes of BuildConfiguration")
        for files in configuration:
            if files.tag != "SourceFileSet" or not set(files.keys()) <= {
                "name", "language", "compiler", "compilerOptions"
            }:  # fmt: skip
                problems.append("attributes of SourceFileSet")
            tags = [e.tag for e in files]
            order = ["SourceFile", "PreprocessorDefinition", "IncludeDirectory"]
            if not set(tags) <= set(order) or tags != sorted(tags, key=order.index):
                problems.append("elements of SourceFileSet")
            for file in files.findall("SourceFile"):
                if f"sources/{file.get('name')}" not in package.names:
                    problems.append(f"no source file {file.get('name')}")
    return problems


def problems_of(package):
    """One sentence for each rule that is broken."""
    xml, version = package.xml, package.version
    problems = []

    def rule(holds, sentence):
        if not holds:
            problems.append(sentence)

    rule(xml.tag == "fmiModelDescription", "the root is fmiModelDescription")
    rule(xml.get("fmiVersion") == f"{version}.0", "fmiVersion")
    rule(bool(xml.get("modelName")), "modelName")
    rule(bool(package.token), "guid or instantiationToken")
    tags = [element.tag for element in xml]
    rule(all(tag in ORDER[version] for tag in tags), f"unknown elements in {tags}")
    rule(tags == sorted(tags, key=ORDER[version].index), f"order of {tags}")
    rule(len(tags) == len(set(tags)), "elements occur once")
    kinds = [xml.find(k) for k in ("ModelExchange", "CoSimulation") if xml.find(k) is not None]
    rule(bool(kinds), "a kind")
    for kind in kinds:
        unknown = set(kind.keys()) - ATTRIBUTES[version][kind.tag]
        rule(not unknown, f"{kind.tag}: {unknown}")
        rule(kind.get("modelIdentifier", "").isidentifier(), f"{kind.tag}: modelIdentifier is a C identifier")
        rule([e.tag for e in kind] in ([], ["SourceFiles"]), f"{kind.tag}: SourceFiles alone is in it")
        rule(version == 2 or len(kind) == 0, f"{kind.tag}: FMI 3 lists sources elsewhere")
        for file in kind.iter("File"):
            rule(f"sources/{file.get('name')}" in package.names, f"no source file {file.get('name')}")
    has_sources = any(name.startswith("sources/") for name in package.names)
    if version == 2:
        rule(has_sources == bool(list(xml.iter("SourceFiles"))), "sources are listed")
    elif has_sources:
        problems += problems_of_build(package)
    platform = "linux64" if version == 2 else "x86_64-linux"
    rule(f"binaries/{platform}/{package.identifier}.so" in package.names, "a binary for Linux")
    rule("resources/vehicle.bin" in package.names, "resources")
    rule("documentation/index.html" in package.names, "documentation")

    units = [u.get("name") for u in xml.iter("Unit")]
    rule(len(units) == len(set(units)), "units are defined once")
    shown = {u.get("name"): {d.get("name") for d in u.iter("DisplayUnit")} for u in xml.iter("Unit")}
    for d in xml.iter("DisplayUnit"):
        rule(set(d.keys()) <= {"name", "factor", "offset"}, f"attributes of the display unit {d.get('name')}")
        rule(float(d.get("factor", "1")) != 0.0, f"factor of {d.get('name')}")
    types = {
        t.get("name"): t for t in xml.find("TypeDefinitions")
        if (t.tag, version) in (("SimpleType", 2), ("EnumerationType", 3))
    }  # fmt: skip
    rule(len(types) == len(xml.find("TypeDefinitions")), "types")
    for name, type_ in types.items():
        items = list(type_.iter("Item"))
        for key in ("name", "value"):
            rule(len({item.get(key) for item in items}) == len(items) > 0, f"{name}: each {key} once")
    variables = list(xml.find("ModelVariables"))
    names = [v.get("name") for v in variables]
    references = [v.get("valueReference") for v in variables]
    rule(len(names) == len(set(names)), "names are unique")
    rule(len(references) == len(set(references)), "value references are unique")
    independents = [v for v in variables if v.get("causality") == "independent"]
    rule(len(independents) == (1 if version == 3 else len(independents)) and len(independents) <= 1, "one time")
    for v in variables:
        name, type_ = v.get("name"), typed(v, version)
        pair = v.get("causality"), v.get("variability")
        real = type_.tag in ("Real", "Float64")
        rule(len(name) <= LONGEST_NAME, f"{name} is longer than {LONGEST_NAME} characters")
        rule("." not in name, f"{name} has a dot")
        rule(pair in INITIAL, f"{name}: {pair}")
        rule(v.get("initial") in [None, *INITIAL.get(pair, [])], f"{name}: initial")
        rule(real or pair[1] != "continuous", f"{name}: only reals are continuous")
        rule(bool(v.get("description")), f"{name}: description")
        initial = v.get("initial") or INITIAL[pair][0]
        start = type_.get("start")
        if type_.tag == "String" and version == 3 and type_.find("Start") is not None:
            start = type_.find("Start").get("value")
        needs = pair[0] in ("input", "parameter") or pair[1] == "constant" or initial in ("exact", "approx")
        rule((start is not None) == needs, f"{name}: start value")
        rule(type_.tag != "Enumeration" or type_.get("declaredType") in types, f"{name}: declared type")
        rule(not type_.get("displayUnit") or type_.get("displayUnit") in shown.get(type_.get("unit"), set()),
             f"{name}: display unit {type_.get('displayUnit')}")  # fmt: skip
        rule(not type_.get("unit") or type_.get("unit") in units, f"{name}: unit {type_.get('unit')}")
        rule(not real or bool(type_.get("unit")), f"{name}: no unit")
        bounds = [float(type_.get(k)) if type_.get(k) else None for k in ("min", "max")]
        if real and start is not None:
            rule(bounds[0] is None or float(start) >= bounds[0], f"{name}: start below min")
            rule(bounds[1] is None or float(start) <= bounds[1], f"{name}: start above max")
        rule(None in bounds or bounds[0] <= bounds[1], f"{name}: min above max")

    by = {str(n + 1): v for n, v in enumerate(variables)} if version == 2 else dict(zip(references, variables))
    structure = xml.find("ModelStructure")
    if version == 2:
        lists = {k: list(structure.find(k)) for k in ("Outputs", "Derivatives", "InitialUnknowns")}
        key = "index"
    else:
        lists = {
            "Outputs": structure.findall("Output"),
            "Derivatives": structure.findall("ContinuousStateDerivative"),
            "InitialUnknowns": structure.findall("InitialUnknown"),
        }
        key = "valueReference"
        order = ["Output", "ContinuousStateDerivative", "ClockedState", "InitialUnknown", "EventIndicator"]
        found = [element.tag for element in structure]
        rule(found == sorted(found, key=order.index), "order of the model structure")
    listed = {name: [by[element.get(key)] for element in elements] for name, elements in lists.items()}
    for name, elements in listed.items():
        rule(len(elements) == len({id(e) for e in elements}), f"{name}: each once")
    rule({id(v) for v in listed["Outputs"]} == {id(v) for v in variables if v.get("causality") == "output"},
         "all outputs are listed")  # fmt: skip
    derivatives = [v for v in variables if typed(v, version).get("derivative")]
    rule([id(v) for v in listed["Derivatives"]] == [id(v) for v in derivatives], "all derivatives are listed")
    states = [by[typed(v, version).get("derivative")] for v in derivatives]
    for state in states:
        rule(state.get("variability") == "continuous", f"{state.get('name')}: states are continuous")
        summed = state.get("name").startswith("sum_")
        driven = state.get("name").startswith("state_supply_phase")
        flies = state.get("name").startswith("state_body_")  # goes on smoothly where a drive jumps
        jumps = xml.find("ModelExchange") is not None and not summed and not driven and not flies
        rule(typed(state, version).get("reinit") == ("true" if jumps else None), f"{state.get('name')}: reinit")
    for v in variables:
        rule(not typed(v, version).get("reinit") or v in states, f"{v.get('name')}: states alone are set anew")
    initial = {
        id(v) for v in variables
        if v.get("causality") == "output" and (v.get("initial") or "calculated") != "exact"
    } | {id(v) for v in derivatives} | {id(v) for v in states}  # fmt: skip
    rule({id(v) for v in listed["InitialUnknowns"]} == initial, "initial unknowns")
    for name, elements in lists.items():
        for element in elements:
            on = element.get("dependencies")
            rule(on is not None, f"{name}: dependencies are said")
            kinds_ = element.get("dependenciesKind", "").split()
            rule(len((on or "").split()) == len(kinds_), f"{name}: a kind for each dependency")
            allowed = {id(v) for v in variables if v.get("causality") == "input"}
            allowed |= {id(v) for v in variables if (v.get("causality") == "parameter" or id(v) in map(id, states))}
            rule(all(id(by[r]) in allowed for r in (on or "").split()), f"{name}: dependencies are knowns")
    indicators = structure.findall("EventIndicator")
    for element in indicators:
        rule(element.get("valueReference") in by, "event indicators are variables")
    if version == 2 and xml.find("ModelExchange") is not None:
        rule(xml.get("numberOfEventIndicators", "").isdigit(), "numberOfEventIndicators")
    return problems
