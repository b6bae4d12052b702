"""Tests and isotherms that contradict the others, before any cause is looked for."""
