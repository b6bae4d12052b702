from asphalt_nscd.api.bending import Test as Test
from asphalt_nscd.api.bending import bend as bend
from asphalt_nscd.api.comparison import Comparison as Comparison
from asphalt_nscd.api.comparison import compare as compare
from asphalt_nscd.api.contacts import solve_contacts as solve_contacts
from asphalt_nscd.api.diagnosis import Diagnosis as Diagnosis
from asphalt_nscd.api.diagnosis import Known as Known
from asphalt_nscd.api.diagnosis import diagnose as diagnose
from asphalt_nscd.api.exporting import ExportSettings as ExportSettings
from asphalt_nscd.api.exporting import export as export
from asphalt_nscd.api.laws import Law as Law
from asphalt_nscd.api.laws import fit as fit
from asphalt_nscd.api.reading import read as read
from asphalt_nscd.api.specimens import Packing as Packing
from asphalt_nscd.api.specimens import Specimen as Specimen
from asphalt_nscd.api.specimens import pour as pour
from asphalt_nscd.api.specimens import read_packing as read_packing
from asphalt_nscd.api.specimens import specimen as specimen
from asphalt_nscd.bending.case import Load as Load
from asphalt_nscd.bending.case import Numerics as Numerics
from asphalt_nscd.bending.condensing import Bonds as Bonds
from asphalt_nscd.bending.rig import Rig as Rig
from asphalt_nscd.diagnosis.run import Draws as Draws
from asphalt_nscd.diagnosis.run import Simulated as Simulated
from asphalt_nscd.files.errors import InputError as InputError
from asphalt_nscd.specimen.preparation import Vibration as Vibration

__version__: str
