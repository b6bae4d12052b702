"""Readers of material cards: E* as each program computes it, by the equations of its manual."""

from __future__ import annotations

import re

import numpy as np

from naive.prony import from_shear_and_bulk, relaxing


def read_abaqus(text):
    """Options of an input file: {keyword: (parameters, data lines)}."""
    options, current = {}, None
    for line in text.splitlines():
        if line.startswith("**"):
            continue
        if line.startswith("*"):
            keyword, *parameters = [part.strip() for part in line[1:].split(",")]
            current = keyword.upper()
            assert current not in options
            options[current] = (dict(part.split("=") for part in parameters), [])
        else:
            fields = [field.strip() for field in line.split(",")]
            assert all(len(field) <= 20 for field in fields)  # of a number of free format
            options[current][1].append([float(field) for field in fields])
    return options


def abaqus_modulus(text, temperature, frequency, stress):
    """E* [Pa] by the equations of the Abaqus manual."""
    options = read_abaqus(text)
    assert list(options)[:3] == ["MATERIAL", "ELASTIC", "VISCOELASTIC"]
    assert options["ELASTIC"][0] == {"MODULI": "INSTANTANEOUS"}
    assert options["VISCOELASTIC"][0] == {"TIME": "PRONY"}
    ((young, nu),) = options["ELASTIC"][1]
    g, k, tau = np.array(options["VISCOELASTIC"][1]).T
    assert g.sum() < 1.0 and k.sum() < 1.0 and (g > 0).all() and (tau > 0).all()
    shift = 1.0
    if "TRS" in options:
        assert options["TRS"][0] == {"DEFINITION": "WLF"}
        ((zero, c1, c2),) = options["TRS"][1]
        shift = 10.0 ** (-c1 * (temperature - zero) / (c2 + temperature - zero))
    omega = 2.0 * np.pi * frequency * shift  # reduced time is t / A
    shear = young / (2.0 * (1.0 + nu)) * relaxing(g, tau, omega)
    bulk = young / (3.0 * (1.0 - 2.0 * nu)) * relaxing(k, tau, omega)
    return stress * from_shear_and_bulk(shear, bulk)


def ansys_modulus(text, temperature, frequency, stress):
    """E* [Pa] by the equations of the Mechanical APDL reference."""
    values, tables, current = {}, {}, None
    for line in text.splitlines():
        if line.startswith("!"):
            continue
        if "=" in line:
            values["number"] = line.split("=")[0].strip()
            continue
        command, *fields = line.split(",")
        if command == "MP":
            assert fields[1] == values["number"]
            values[fields[0]] = float(fields[2])
        elif command == "TB":
            current = tuple(fields[0::4]) if fields[0] == "PRONY" else (fields[0], fields[4])
            assert fields[1] == values["number"] and fields[2] == "1"
            tables[current] = (int(fields[3]), {})
        else:
            assert command == "TBDATA" and len(fields) <= 7
            for place, value in enumerate(fields[1:], start=int(fields[0])):
                assert place not in tables[current][1]
                tables[current][1][place] = float(value)
    relaxation = {}
    for part in ("SHEAR", "BULK"):
        terms, data = tables["PRONY", part]
        assert sorted(data) == list(range(1, 2 * terms + 1))
        relaxation[part] = np.array([data[place] for place in sorted(data)]).reshape(-1, 2).T
    faster = 1.0
    if ("SHIFT", "WLF") in tables:
        data = tables["SHIFT", "WLF"][1]
        above = temperature - data[1]
        faster = 10.0 ** (data[2] * above / (data[3] + above))  # multiplies the time
    omega = 2.0 * np.pi * frequency / faster
    young, nu = values["EX"], values["PRXY"]
    shear = young / (2.0 * (1.0 + nu)) * relaxing(*relaxation["SHEAR"], omega)
    bulk = young / (3.0 * (1.0 - 2.0 * nu)) * relaxing(*relaxation["BULK"], omega)
    return stress * from_shear_and_bulk(shear, bulk)


def comsol_modulus(text, temperature, frequency, unit):
    """E* [Pa] of a linear elastic parent with branches, all strains viscoelastic."""
    said = dict(re.findall(r"^% (E_long|nu|Tref|C1WLF|C2WLF) (\S+)$", text, re.M))
    scale = {"Pa": 1.0, "MPa": 1e6}[re.search(r"\[(M?Pa)\]", said["E_long"])[1]]
    assert scale == unit
    number = {name: float(re.sub(r"\[.*\]", "", value)) for name, value in said.items()}
    ratio = float(re.search(r"Km = (\S+)\*Gm", text)[1])
    rows = np.array(
        [[float(x) for x in line.split()] for line in text.splitlines() if not line.startswith("%")]
    )
    branch, shear, tau = rows.T
    assert branch.tolist() == list(range(1, len(rows) + 1))
    shift = np.ones_like(temperature)
    if "Tref" in number:
        above = temperature + 273.15 - number["Tref"]
        shift = 10.0 ** (-number["C1WLF"] * above / (number["C2WLF"] + above))
    turned = 1j * (2.0 * np.pi * frequency * shift)[:, None] * tau
    whole = (shear * turned / (1.0 + turned)).sum(axis=1)
    nu, young = number["nu"], number["E_long"]
    return scale * from_shear_and_bulk(
        young / (2.0 * (1.0 + nu)) + whole, young / (3.0 * (1.0 - 2.0 * nu)) + ratio * whole
    )
