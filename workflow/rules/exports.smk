# The law of the diagnosis in the files of other programs.

# Format: its file.
EXPORTS = {
    "abaqus": "<results>/exports/law.inp",
    "ansys": "<results>/exports/law.mac",
    "comsol": "<results>/exports/law.txt",
    "xlsx": "<results>/exports/law.xlsx",
    "csv": "<results>/prony.csv",
    "mepdg": "<results>/dynamic_modulus.csv",
}
EXPORTED = list(EXPORTS.values()) if COMMON_LAW else []


if COMMON_LAW:
    for form, path in EXPORTS.items():

        rule:
            name:
                f"export_{form}"
            input:
                law=COMMON_LAW,
                diagnosed=DIAGNOSED,
                code=code("export", f"exports.formats.{form}"),
            output:
                path,
            log:
                f"<results>/logs/export/{form}.log",
            benchmark:
                f"<results>/benchmarks/export/{form}.tsv"
            group:
                "contents"
            conda:
                ENVIRONMENT
            params:
                form=form,
            message:
                f"Export the law of the diagnosis for {form}"
            shell:
                "asphalt-nscd export {input.law} --format {params.form} --output {output} > {log} 2>&1"
