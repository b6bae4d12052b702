# Entries of cases.smk beside the paper: looser samples, and readings of the paper that fail.

if PACKING:  # looser samples beside one of the study's
    PACKING_TEST = {
        "sample": PACKED,
        "temperature": label(PACKING["temperature_C"]),
        "frequency": label(PACKING["frequency_Hz"]),
    }
    TESTS["simulate_packed"] = Tests(
        "packing",
        "Test sample {wildcards.sample} for its packing",
        place=ONE_TEST,
    )
    if REMAPPED:
        TESTS["simulate_packed_facets"] = Tests(
            "facets/packing",
            "Test sample {wildcards.sample} with facets for its packing",
            place=ONE_TEST,
            model=model("facets/"),
        )
    PACKING_TESTS = TESTS["simulate_packed"].files(**PACKING_TEST)
    PACKING_FACETS = TESTS["simulate_packed_facets"].files(**PACKING_TEST) if REMAPPED else []
    KEPT += [*PACKING_TESTS, *PACKING_FACETS]

if AUDIT:  # readings of the paper that fail
    TESTS["simulate_pascal"] = Tests(
        "pascal",
        "Test with Table 3 in Pa",
        law="<results>/laws/pascal/T{temperature}.json",
        source="pascal",
        test=STEADY,  # in a specimen a thousand times softer, waves from the start do not die out
    )
    TESTS["simulate_blocked"] = Tests(
        "blocked",
        "Test with the head's rotation blocked",
        model=model(head="blocked"),
        test=STEADY,  # a head that cannot rotate, as in Eqs. (1)-(3), overloads bonds, which would hide its own effect
    )
    _at = {"sample": f"s{AUDIT['seed']}", "temperature": label(AUDIT["temperature_C"])}
    BLOCKED = TESTS["simulate_blocked"].files(**_at)
    _both = [path for pair in zip(TESTS["simulate_pascal"].files(**_at), BLOCKED) for path in pair]
    COLLECTED["readings"] = ("readings.csv", _both, "tests under other readings")
    _blocked = TESTS["simulate_blocked"].model
    KEPT += expand([TESTS["simulate_pascal"].law, f"{_blocked}.h5", f"{_blocked}.excerpt.h5"], **_at)

if LIKELY:  # as the authors most likely did: pairs within dmin of the spheres as they are once reduced
    _sample = loose(f"s{AUDIT['seed']}", AUDIT["likeliest_friction"])
    _gap = BONDS["gap_max_mm"] * (1.0 - BONDS["volume_reduction"]) ** (1.0 / 3.0)
    SPECIMENS["_likely"] = Specimens(
        "likely/",
        how=" as the authors most likely did",
        bonds=f"{options(BONDS, 'volume_reduction')} --gap-max-mm {_gap}",
        tested=_sample,
        others=[],
    )
    TESTS["simulate_likely"] = Tests(
        "likely/tests",
        "Test sample {wildcards.sample} as the authors most likely did, at {wildcards.temperature} degC",
        model=model("likely/"),
    )
    COLLECTED["likely_simulations"] = (
        "likely.csv",
        TESTS["simulate_likely"].files(sample=_sample),
        "tests under the likeliest reading",
    )
