# The law of the diagnosis in the files of other programs.

# Format: the module that writes it, its file.
EXPORTS = {
    "abaqus": ("abaqus", "<results>/exports/law.inp"),
    "ansys": ("ansys", "<results>/exports/law.mac"),
    "comsol": ("comsol", "<results>/exports/law.txt"),
    "xlsx": ("workbook", "<results>/exports/law.xlsx"),
    "csv": ("prony_table", "<results>/prony.csv"),
    "mepdg": ("mepdg", "<results>/dynamic_modulus.csv"),
}
EXPORTED = [path for _, path in EXPORTS.values()] if COMMON_LAW else []


if COMMON_LAW:
    for form, (module, path) in EXPORTS.items():

        rule:
            name:
                f"export_{form}"
            input:
                law=COMMON_LAW,
                diagnosed=DIAGNOSED,
                code=code("export", f"exports.{module}"),
            output:
                path,
            params:
                form=form,
            conda:
                ENVIRONMENT
            log:
                f"<results>/logs/export/{form}.log",
            benchmark:
                f"<results>/benchmarks/export/{form}.tsv"
            group:
                "contents"
            message:
                f"Export the law of the diagnosis for {form}"
            shell:
                "asphalt-nscd export {input.law} --format {params.form} --output {output} > {log} 2>&1"
