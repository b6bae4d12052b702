# The package, Snakemake and all they need, in the versions of requirements-study.txt.
#
#   docker build --tag asphalt-nscd --build-arg COMMIT="$(git rev-parse HEAD)" .
#   docker run --rm --volume "$PWD:/study" --workdir /study asphalt-nscd snakemake --cores all --configfile mine.yaml
#
# For `snakemake --sdm apptainer`, which looks for this file in the folder it runs in:
#   apptainer build asphalt-nscd.sif docker-daemon://asphalt-nscd:latest
FROM python:3.11-slim-bookworm

ENV PYTHONUNBUFFERED=1 ASPHALT_NSCD_CACHE=/tmp/asphalt-nscd
WORKDIR /opt/asphalt-nscd
COPY requirements-study.txt ./
RUN pip install --no-cache-dir --require-hashes --requirement requirements-study.txt
COPY . .
ARG COMMIT=unknown
RUN echo "$COMMIT" >src/asphalt_nscd/commit.txt
RUN pip install --no-cache-dir --no-deps --no-build-isolation --editable . \
    --editable plugins/snakemake-logger-plugin-steps --editable plugins/snakemake-executor-plugin-slurm-chunks

CMD ["asphalt-nscd", "--help"]
